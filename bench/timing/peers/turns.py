"""Rounds of ours and of theirs that take turns."""

from collections.abc import Callable
from statistics import median
from time import perf_counter
from typing import NamedTuple, Self

Round = Callable[[], float]
"""One round of work; returns the seconds of one unit of it (a step, a search)."""

ROUNDS = 21


class Turns(NamedTuple):
    """What was measured."""

    work: str
    peer: str
    ours: list[float]
    """Seconds of a unit in each round."""
    theirs: list[float]
    figure: Callable[[list[float]], str]
    """Writes one side's figure."""

    @classmethod
    def take(cls, work: str, peer: str, ours: Round, theirs: Round, figure: Callable[[list[float]], str]) -> Self:
        """Run a round of each that does not count, then all rounds in turn."""
        ours(), theirs()
        pairs = [(ours(), theirs()) for _ in range(ROUNDS)]
        return cls(work, peer, *map(list, zip(*pairs, strict=True)), figure)

    def ratio(self) -> tuple[float, float, float]:
        """How many times as fast ours is: the median over the rounds, the least and the most."""
        ratios = [theirs / ours for ours, theirs in zip(self.ours, self.theirs, strict=True)]
        return median(ratios), min(ratios), max(ratios)


def elapsed(work: Callable[[], object]) -> Round:
    """Seconds by the wall clock, for work on several threads."""

    def one_round() -> float:
        began = perf_counter()
        work()
        return perf_counter() - began

    return one_round


def per_second(seconds: list[float]) -> str:
    """A rate."""
    return f"{1 / median(seconds):,.0f} steps/s"


def milliseconds(seconds: list[float]) -> str:
    """A duration."""
    return f"{1e3 * median(seconds):.3f} ms"
