"""Episodes played in worker processes of this machine, which may hang and die.

One episode is one task. A worker that hangs is ended and one that dies is replaced; either costs the episode that it
was playing, whose record says so.
"""

import signal
from collections.abc import Iterator
from concurrent.futures import Future
from itertools import islice
from queue import Empty, SimpleQueue
from typing import NamedTuple

from pebble import ProcessExpired

from fogbench.bench.playing import worker
from fogbench.bench.playing.episode import Episode
from fogbench.bench.playing.loop import ClerkError
from fogbench.bench.playing.pool import worker_pool
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import MapError, Outcome

AHEAD = 4
"""Tasks that are handed out for each worker, so that none waits for its next."""

PATIENCE = 300.0
"""Seconds that the facts of a lost episode's world may take, whatever its limit: a new process may compile first."""


class RunError(Mistake):
    """A run that cannot go on; its text is one line. What was recorded is kept."""


class Job(NamedTuple):
    """An episode to play, or to record as lost."""

    variant: str
    agent: str
    episode: int
    hard_seconds: float
    loss: tuple[()] | tuple[Outcome, str] = ()
    """How it was lost, with a sentence."""


def play_here(scenario: Scenario, jobs: Iterator[Job], workers: int) -> Iterator[Episode | None]:
    """The rows of the jobs as they get ready; None whenever a second has passed without any."""
    waiting: dict[Future[Episode], Job] = {}
    ended: SimpleQueue[Future[Episode]] = SimpleQueue()
    with worker_pool(scenario, workers) as pool:

        def submit(job: Job) -> None:
            task = worker.lose if job.loss else worker.play
            future = pool.schedule(task, args=(*job[:3], *job.loss), timeout=job.hard_seconds)
            waiting[future] = job
            future.add_done_callback(ended.put)

        for job in islice(jobs, AHEAD * workers):
            submit(job)
        while waiting:
            try:
                future = ended.get(timeout=1)
            except Empty:
                yield None
                continue
            answer = _answer(future, waiting.pop(future))
            if isinstance(answer, Job):
                submit(answer)
                continue
            yield answer
            for job in islice(jobs, 1):
                submit(job)


def _answer(future: Future[Episode], job: Job) -> Episode | Job:
    """The row of a job, or the job of recording that it was lost."""
    error = future.exception()
    if error is None:
        return future.result()
    place = f"{job.variant}, episode {job.episode}"
    if isinstance(error, TimeoutError):
        loss = Outcome.HUNG, f"no answer after {job.hard_seconds:g} s, ended from outside"
    elif isinstance(error, ProcessExpired):
        loss = Outcome.CRASHED, _death(error.exitcode)
    elif isinstance(error, MapError):
        raise RunError(error.within(place))
    elif isinstance(error, ClerkError):
        raise RunError(f"{place}: {error}.")
    else:
        raise RunError(f"{place}, {job.agent}: got {type(error).__name__}: {error}; expected no error but an agent's.")
    if job.loss:
        raise RunError(f"{place}: {loss[1]}; expected its world to be made.")
    return job._replace(loss=loss, hard_seconds=PATIENCE)


def _death(code: int) -> str:
    how = f"was ended by {signal.Signals(-code).name}" if code < 0 else f"ended with exit code {code}"
    return f"the agent's process {how}"
