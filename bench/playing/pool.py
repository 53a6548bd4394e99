"""The pool of worker processes: one thread and one process group each, under a limit that their clock alone counts.

A worker has some tasks at once and answers them in order. One that dies is replaced, and one that is over its limit is
ended; that costs the task in its hand.
"""

import os
import signal
import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing import get_context, resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from time import monotonic
from typing import Any, NamedTuple

from fogbench.bench.playing.guardian import Guardian, end_group
from fogbench.bench.playing.relay import Prints, relayed
from fogbench.bench.playing.worker import serve
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Outcome

VARIABLES = {
    **dict.fromkeys(
        ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS", "NUMBA_NUM_THREADS"),
        "1",
    ),
    "PYTHONHASHSEED": "0",
}
"""The environment of a worker: threads would get into each other's way, and sets of texts keep their order."""

AHEAD, QUICK = 4, 0.1
"""Tasks that a worker has at once where one takes less than so many seconds, so that it need not wait for its next."""

TICK, LATE = 0.5, 0.1
"""Seconds of one look at the workers, and by how much more one may take and still count as a whole."""

PATIENCE = 300.0
"""Seconds for what is nobody's fault: a new process reads the scenario, and may compile first."""


class RunError(Mistake):
    """A run that cannot go on; its text is one line. What was recorded is kept."""


class Task(NamedTuple):
    """A call in a worker."""

    call: Callable[..., Any]
    """A function of `fogbench.bench.playing.worker`."""
    arguments: tuple[Any, ...]
    seconds: float
    """The limit; however large."""


class Lost(NamedTuple):
    """The answer to a task that took its process with it."""

    outcome: Outcome
    detail: str
    traceback: str
    """Where it crashed, as far as it could tell."""


@dataclass(eq=False)
class Worker:
    """A process and its tasks; the first is in its hand."""

    process: SpawnProcess
    pipe: "Connection[Any, Any]"
    words: "Connection[Any, Any]"
    """Its last ones."""
    tasks: deque[Task] = field(default_factory=deque)
    ready: bool = False
    room: int = 1
    """Tasks that it may have."""
    left: float = PATIENCE
    """Seconds of the limit."""

    def give(self, task: Task) -> None:
        """One more task."""
        self.tasks.append(task)
        if self.ready and len(self.tasks) == 1:
            self.left = task.seconds
        with suppress(OSError):  # it is dead, which the next look tells
            self.pipe.send(task[:2])

    def heard(self) -> Iterator[tuple[Task, Any]]:
        """What it has answered."""
        while self.pipe.poll():
            try:
                answer = self.pipe.recv()
            except (EOFError, OSError):
                return  # it has closed the pipe: it is dead, or about to be
            if self.ready:
                task = self.tasks.popleft()
                self.room = AHEAD if task.seconds - self.left < QUICK else 1
                yield task, answer
            self.ready = True
            self.left = self.tasks[0].seconds if self.tasks else 0.0

    def last_words(self) -> str:
        """What it has said of where it crashed."""
        return os.read(self.words.fileno(), 2**16).decode("utf-8", "replace") if self.words.poll() else ""

    @property
    def busy(self) -> bool:
        """Whether it works, so that its limit counts."""
        return bool(self.tasks) or not self.ready


class Pool:
    """Workers that know a scenario."""

    def __init__(self, scenario: Scenario, count: int, prints: Prints) -> None:
        """A pool that is to have so many, which print there; none of them runs yet."""
        self.arguments, self.count = (prints, scenario.text, scenario.path, count), count
        self.guardian = Guardian()
        self.workers: list[Worker] = []
        self.last = monotonic()

    def begin(self) -> None:
        """Start the workers."""
        while len(self.workers) < self.count:
            self.workers.append(self._start())

    @property
    def has_room(self) -> bool:
        """Whether a worker can take one more task."""
        return any(len(worker.tasks) < worker.room for worker in self.workers)

    @property
    def busy(self) -> bool:
        """Whether there will be an answer."""
        return any(worker.tasks for worker in self.workers)

    def give(self, task: Task) -> None:
        """Hand out a task, to the worker that has the fewest."""
        min(self.workers, key=lambda worker: len(worker.tasks) - worker.room).give(task)

    def answers(self) -> Iterator[tuple[Task, Any]]:
        """What the workers answer within a tick; what they were lost with is `Lost`.

        A tick counts as long as it was meant to take, or a little more: while this process itself did not run, nobody's
        limit goes by, whatever the clock says.

        Raises:
            RunError: a worker could not begin.
        """
        planned = max(0.0, min([TICK, *(worker.left for worker in self.workers if worker.busy)]))
        wait([each for worker in self.workers for each in (worker.pipe, worker.process.sentinel)], planned)
        now = monotonic()
        spent, self.last = min(now - self.last, planned + LATE), now
        for worker in list(self.workers):
            worker.left -= spent
            dead = worker.process.exitcode is not None  # a look before the last one into its pipe
            yield from worker.heard()
            if dead or (worker.busy and worker.left <= 0):
                yield from self._replace(worker)

    def _replace(self, worker: Worker) -> Iterator[tuple[Task, Lost]]:
        """Put another one into the place of a worker that died, or hangs; it gets the tasks that were not begun."""
        code, words = worker.process.exitcode, worker.last_words()
        self._end(worker)
        if not worker.ready:
            told = f"a worker process that {_death(code)}" if code is not None else "a worker process that hangs"
            raise RunError(f"{self.arguments[2]}: got {told} as it reads the scenario; expected one that can play.")
        fresh = self.workers[self.workers.index(worker)] = self._start()
        if worker.tasks:
            task = worker.tasks.popleft()
            hung = Lost(Outcome.HUNG, f"no answer after {task.seconds:g} s", "")
            yield task, hung if code is None else Lost(Outcome.CRASHED, f"the agent's process {_death(code)}", words)
        for task in worker.tasks:
            fresh.give(task)

    def _start(self) -> Worker:
        context = get_context("spawn")
        (here, there), (hears, says) = context.Pipe(), context.Pipe(duplex=False)
        process = context.Process(target=serve, args=(there, says, *self.arguments), daemon=False)
        with _deaf():
            process.start()
        there.close()
        says.close()
        assert process.pid is not None
        self.guardian.toggle(process.pid)
        return Worker(process, here, hears)

    def _end(self, worker: Worker) -> None:
        assert worker.process.pid is not None
        end_group(worker.process.pid)
        worker.process.kill()  # which may have no group yet
        worker.process.join()
        self.guardian.toggle(worker.process.pid)
        worker.pipe.close()
        worker.words.close()

    def end(self) -> None:
        """End all workers, whatever they are doing, and all that was started in them."""
        for worker in self.workers:
            self._end(worker)
        self.guardian.dismiss()


def cpus() -> int:
    """How many CPUs this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


@contextmanager
def worker_pool(scenario: Scenario, workers: int) -> Iterator[Pool]:
    """A pool whose processes know the scenario; at the end nothing is left of it."""
    with _environment(VARIABLES), relayed() as prints:
        pool = Pool(scenario, workers, prints)
        try:
            pool.begin()
            yield pool
        finally:
            pool.end()


def _death(code: int) -> str:
    return f"was ended by {signal.Signals(-code).name}" if code < 0 else f"ended with exit code {code}"


@contextmanager
def _deaf() -> Iterator[None]:
    """What is started in here does not hear of Ctrl-C, which a terminal sends to all processes of a command."""
    resource_tracker.ensure_running()  # its start would end the deafness
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _environment(variables: dict[str, str]) -> Iterator[None]:
    """Set environment variables for a while; processes that are started meanwhile inherit them."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
