"""Two workers beside one: the same scenario through the real runner, in turn.

    python bench/timing/workers.py

Timed is from the first recorded episode to the last, so that the start of the processes, paid once per run, is out.
"""

from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from bench.playing.runner import Progress, run
from bench.reading.scenario import read_scenario

ROUNDS = 3

TEXT = """
name: workers
about: Episodes of some 100 ms that compute all the time.
maps: {blobs: {size: 16, obstacles: [0, 12], obstacle_size: [1, 3]}}
rules: {collision: blocked}
tasks: {distance: [10, 40]}
budget: {steps: 40}
agents: ["./busy.py:Busy": {count: 150000}]
episodes: 100
"""


def main() -> None:
    """Print the figures of each round and the median ratio."""
    ratios = []
    for _ in range(ROUNDS):
        one, two = (seconds_per_episode(workers) for workers in (1, 2))
        ratios.append(one / two)
        print(f"one worker {1e3 * one:.1f} ms per episode, two {1e3 * two:.1f} ms: {one / two:.2f} times as fast")
    print(f"two workers are {median(ratios):.2f} times as fast as one (median of {ROUNDS} rounds)")


def seconds_per_episode(workers: int) -> float:
    """Seconds between recorded episodes."""
    times: list[float] = []

    def watch(progress: Progress) -> None:
        if progress.outcome is not None:
            times.append(perf_counter())

    with TemporaryDirectory() as folder:
        run(read_scenario(TEXT, Path(__file__)), Path(folder), workers, watch)
    return (times[-1] - times[0]) / (len(times) - 1)


if __name__ == "__main__":  # each worker process imports this file
    main()
