"""`python -m bench` is `fogbench`."""

from bench.command import main

if __name__ == "__main__":
    main()
