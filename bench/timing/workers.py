"""Two workers beside one: the same scenario through the real runner, and the same work in plain processes.

    python bench/timing/workers.py

What two plain processes gain over one is all that the machine has to give: where its CPUs are two threads of one core,
or others use them, that is far from 2, and it changes by the second: hence many short rounds and their median. Timed is
from the moment when each worker has one episode recorded to the last record, so that the start of the workers, paid
once per run, is out.
"""

import sys
from pathlib import Path
from statistics import median
from subprocess import PIPE, Popen
from tempfile import TemporaryDirectory
from time import perf_counter

from bench.playing.runner import Progress, run
from bench.reading.scenario import read_scenario

ROUNDS = 15
STEPS, COUNT = 40, 150_000
EPISODES = 40

TEXT = f"""
name: workers
about: Episodes of some 100 ms that compute all the time.
maps: {{blobs: {{size: 16, obstacles: [0, 12], obstacle_size: [1, 3]}}}}
rules: {{collision: blocked}}
tasks: {{distance: [10, 40]}}
budget: {{steps: {STEPS}}}
agents: ["./busy.py:Busy": {{count: {COUNT}}}]
episodes: {EPISODES}
"""

PLAIN = f"""
from time import perf_counter
began = perf_counter()
for _ in range({EPISODES * STEPS // 2}):
    sum(range({COUNT}))
print(perf_counter() - began)
"""
"""Half of the episodes, without anything around them."""


def main() -> None:
    """Print the gain of two over one in each round, and the medians."""
    gains = []
    for _ in range(ROUNDS):
        runner, plain = (side(1) / side(2) for side in (seconds_per_episode, seconds_in_plain_processes))
        gains.append((runner, plain, runner / plain))
        print(f"two beside one: {runner:.2f} times as fast in the runner, {plain:.2f} in plain processes")
    runner, plain, share = (median(column) for column in zip(*gains, strict=True))
    print(f"medians of {ROUNDS} rounds: runner {runner:.2f}, plain processes {plain:.2f}, their ratio {share:.2f}")


def seconds_per_episode(workers: int) -> float:
    """Seconds between recorded episodes."""
    times: list[float] = []

    def watch(progress: Progress) -> None:
        if progress.outcome is not None:
            times.append(perf_counter())

    with TemporaryDirectory() as folder:
        run(read_scenario(TEXT, Path(__file__)), Path(folder), workers, watch)
    return (times[-1] - times[workers - 1]) / (len(times) - workers)


def seconds_in_plain_processes(processes: int) -> float:
    """Seconds per episode when nothing but the agents' work is done."""
    running = [Popen([sys.executable, "-c", PLAIN], stdout=PIPE, text=True) for _ in range(processes)]
    slowest = max(float(process.communicate()[0]) for process in running)
    return slowest / (EPISODES // 2) / processes


if __name__ == "__main__":  # each worker process imports this file
    main()
