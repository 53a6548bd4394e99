"""`python -m fogbench` is `fogbench`."""

from fogbench.bench.command import main

if __name__ == "__main__":
    main()
