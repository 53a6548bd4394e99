"""What is left to play of a scenario, in order, and which agents are not asked again because they hang.

The first episodes of an agent in a variant, by their numbers, decide: the others wait until one of them has ended, and
are left out where all of them hung. So the same episodes are played whatever the number of workers.
"""

from collections import defaultdict, deque
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import pandas as pd

from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.types import Outcome

FIRST = 3
"""Episodes that an agent may hang in, if they are the first of a variant, before it is not asked for the rest."""

Pair = tuple[str, str]
"""A variant and an agent, by their names."""

Outcomes = Mapping[Pair, Mapping[int, str]]
"""How the recorded episodes of each variant and agent ended, by their numbers."""


class Job(NamedTuple):
    """An episode to play."""

    variant: str
    agent: str
    episode: int
    hard_seconds: float


def has_hung(ends: Mapping[int, str]) -> bool:
    """Whether an agent hung in all of its first episodes of a variant."""
    return all(ends.get(episode) == Outcome.HUNG.name for episode in range(FIRST))


def is_given_up(ends: Mapping[int, str]) -> bool:
    """Whether an agent has played nothing else, so that nobody knows its rate."""
    return len(ends) == FIRST and has_hung(ends)


def outcomes(rows: pd.DataFrame) -> dict[int, str]:
    """How the recorded episodes of an agent in a variant ended."""
    return dict(zip(rows["episode"], rows["outcome"], strict=True))


class Agenda:
    """Jobs, of which some wait for how others end."""

    def __init__(self, scenario: Scenario, done: Outcomes) -> None:
        """All that is not done."""
        self.firsts: dict[Pair, dict[int, str]] = defaultdict(dict)
        for pair, ends in done.items():
            self.firsts[pair] = {k: ends[k] for k in range(FIRST) if k in ends}
        self.left = _jobs(scenario, done)
        self.waiting: dict[Pair, deque[Job]] = defaultdict(deque)
        self.freed = deque[Job]()

    @property
    def hung(self) -> list[Pair]:
        """Who is not asked again."""
        return [pair for pair, ends in self.firsts.items() if has_hung(ends)]

    def next(self) -> Job | None:
        """The next job; None where there is none, or all that are left wait."""
        if self.freed:
            return self.freed.popleft()
        for job in self.left:
            if self._is_free(job):
                return job
            if not has_hung(self.firsts[job[:2]]):
                self.waiting[job[:2]].append(job)
        return None

    def ended(self, variant: str, agent: str, episode: int, outcome: str) -> None:
        """Take note of how an episode ended."""
        pair = (variant, agent)
        if episode >= FIRST:
            return
        self.firsts[pair][episode] = outcome
        if len(self.firsts[pair]) == FIRST or outcome != Outcome.HUNG.name:
            waiting = self.waiting.pop(pair, ())
            self.freed += () if has_hung(self.firsts[pair]) else waiting

    def _is_free(self, job: Job) -> bool:
        known = self.firsts[job[:2]].values()
        return job.episode < FIRST or any(outcome != Outcome.HUNG.name for outcome in known)


def _jobs(scenario: Scenario, done: Outcomes) -> Iterator[Job]:
    """What is left to play; all agents of an episode one after the other, so that a worker may still have its world."""
    for variant in scenario.variants:
        labels = [entry.label for entry in variant.agents if not entry.skipped]
        for episode in range(variant.episodes):
            for label in labels:
                if episode not in done.get((variant.name, label), ()):
                    yield Job(variant.name, label, episode, variant.conditions.budget.hard_seconds)
