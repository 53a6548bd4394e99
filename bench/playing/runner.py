"""The runner: plays what is not recorded yet, in worker processes that may hang and die.

One episode is one task. A worker that hangs is ended and one that dies is replaced; either costs the episode that it
was playing, whose record says so.
"""

import signal
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import NamedTuple

from pebble import ProcessExpired

from fogbench.bench.playing import worker
from fogbench.bench.playing.episode import Episode
from fogbench.bench.playing.pool import worker_pool
from fogbench.bench.playing.provenance import noted
from fogbench.bench.playing.store import recorded, recording
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import MapError, Outcome

AHEAD = 4
"""Tasks that are handed out for each worker, so that none waits for its next."""

PATIENCE = 300.0
"""Seconds that the facts of a lost episode's world may take, whatever its limit: a new process may compile first."""

Recorded = dict[tuple[str, str], set[int]]
"""The recorded episodes of each (variant, agent)."""


class RunError(Mistake):
    """A run that cannot go on; its text is one line. What was recorded is kept."""


class Progress(NamedTuple):
    """How far one agent is in one variant."""

    variant: str
    agent: str
    done: int
    total: int
    outcome: Outcome | None
    """How its last episode ended; None: the count before the first."""


@dataclass
class Summary:
    """What a run did."""

    kept: int
    """Episodes that were recorded before."""
    outcomes: Counter[Outcome] = field(default_factory=Counter)
    """How the episodes ended that were played now."""


class Job(NamedTuple):
    """An episode to play, or to record as lost."""

    variant: str
    agent: str
    episode: int
    hard_seconds: float
    loss: tuple[()] | tuple[Outcome, str] = ()
    """How it was lost, with a sentence."""


def run(scenario: Scenario, folder: Path, workers: int, watch: Callable[[Progress], None]) -> Summary:
    """Play and record all episodes of a scenario that are not recorded yet.

    Args:
        scenario: what to play; the workers read its text again.
        folder: of its store.
        workers: processes side by side; their number changes nothing in the records but the timings.
        watch: told the count of each variant and agent before the first episode, then after each of theirs.

    Raises:
        RunError: a world cannot be made, or the project has a bug.
        StoreError: the store is broken, or cannot be written.
        Mistake: another run records there.
    """
    covariates = dict.fromkeys(name for variant in scenario.variants for name in variant.conditions.covariates)
    with recording(folder, tuple(covariates)) as recorder:
        done = recorded(folder, scenario)
        counts = {pair: len(episodes) for pair, episodes in done.items()}
        totals = _totals(scenario)
        for pair, total in totals.items():
            watch(Progress(*pair, counts.setdefault(pair, 0), total, None))
        summary = Summary(kept=sum(counts.values()))
        workers = min(workers, sum(totals.values()) - summary.kept)
        if not workers:
            return summary
        with noted(folder, scenario, workers):
            for row in _play(scenario, _jobs(scenario, done), workers):
                if row is None:
                    recorder.flush_if_due()
                    continue
                recorder.append(row)
                pair, outcome = (row.variant, row.agent), Outcome[row.outcome]
                counts[pair] += 1
                summary.outcomes[outcome] += 1
                watch(Progress(*pair, counts[pair], totals[pair], outcome))
    return summary


def _totals(scenario: Scenario) -> dict[tuple[str, str], int]:
    return {
        (variant.name, entry.label): variant.episodes
        for variant in scenario.variants
        for entry in variant.agents
        if not entry.skipped
    }


def _jobs(scenario: Scenario, done: Recorded) -> Iterator[Job]:
    """What is left to play; all agents of an episode one after the other, so that a worker may still have its world."""
    for variant in scenario.variants:
        labels = [entry.label for entry in variant.agents if not entry.skipped]
        for episode in range(variant.episodes):
            for label in labels:
                if episode not in done.get((variant.name, label), ()):
                    yield Job(variant.name, label, episode, variant.conditions.budget.hard_seconds)


def _play(scenario: Scenario, jobs: Iterator[Job], workers: int) -> Iterator[Episode | None]:
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
        raise RunError(f"{place}: {error}.")
    else:
        raise RunError(f"{place}, {job.agent}: got {type(error).__name__}: {error}; expected no error but an agent's.")
    if job.loss:
        raise RunError(f"{place}: {loss[1]}; expected its world to be made.")
    return job._replace(loss=loss, hard_seconds=PATIENCE)


def _death(code: int) -> str:
    how = f"was ended by {signal.Signals(-code).name}" if code < 0 else f"ended with exit code {code}"
    return f"the agent's process {how}"
