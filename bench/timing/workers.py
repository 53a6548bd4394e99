"""Two workers beside one: the same scenario through the real runner, and the same work in plain processes.

    python bench/timing/workers.py

What two plain processes gain over one is all that the machine has to give: where its CPUs are two threads of one core,
or others use them, that is far from 2, and it changes by the second: hence many short rounds, of which all seconds are
added up. Timed is from the moment when each worker has one episode recorded to the last record, so that the start of
the workers, paid once per run, is out.
"""

import sys
from pathlib import Path
from subprocess import PIPE, Popen
from tempfile import TemporaryDirectory
from time import perf_counter

from fogbench.bench.playing.runner import Progress, run
from fogbench.bench.reading.scenario import read_scenario

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
    """Print the gain of two over one in each round, and over all of them."""
    rounds = []
    for _ in range(ROUNDS):
        rounds.append([side(count) for side in (seconds_per_episode, seconds_in_plain_processes) for count in (1, 2)])
        print(_gains(rounds[-1]))
    print(f"in all {ROUNDS} rounds together: {_gains([sum(column) for column in zip(*rounds, strict=True)])}")


def _gains(seconds: list[float]) -> str:
    runner, runners, plain, plains = seconds
    return f"two beside one: {runner / runners:.2f} times in the runner, {plain / plains:.2f} in plain processes"


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
