"""Questions to one run that have a curve for an answer: what if the budget had been smaller, or the goal nearer?"""

from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from fogbench.bench.reporting.metrics import decided, reached
from fogbench.bench.reporting.statistics import Estimate, share
from fogbench.worlds.types import Array

BINS = 8
"""Bins of goal distance at most."""

EPISODES_A_BIN = 20
"""How many episodes a bin should hold at least."""


class Steps(NamedTuple):
    """A curve that jumps: `share` [m] of the episodes are solved with a budget of `budget` [m] or more."""

    budget: Array
    share: Array


def success_by_steps(cell: pd.DataFrame) -> Steps:
    """Success against the step budget, up to the one that was played with: solved in at most so many decisions."""
    return _success_within(cell.loc[reached(cell), "steps"], len(cell))


def success_by_seconds(cell: pd.DataFrame) -> Steps:
    """Success against a budget of wall-clock time for all decisions [s].

    An episode that did not reach the goal is censored: nobody knows when it would have, so no budget solves it.
    """
    return _success_within(cell.loc[reached(cell), "decision_seconds"].map(np.sum), len(cell))


def _success_within(spent: ArrayLike, n: int) -> Steps:
    budget, solved = np.unique(np.asarray(spent, np.float64), return_counts=True)
    return Steps(budget, solved.cumsum() / n)


def distance_bins(variant: pd.DataFrame) -> Array:
    """[n + 1] edges of n bins of goal distance (full-map optimum) that hold equally many of the variant's episodes."""
    distance = variant[["episode", "shortest"]].drop_duplicates("episode")["shortest"]
    bins = int(np.clip(len(distance) // EPISODES_A_BIN, 1, BINS))
    return np.unique(np.quantile(distance, np.linspace(0, 1, bins + 1)))


class Bin(NamedTuple):
    """The episodes of one agent at similar goal distances."""

    distance: float
    """Their mean goal distance."""
    success: Estimate
    peak_memory: float
    """Mean of the most bytes carried between decisions [bytes]; NaN if no episode has a decision."""


def by_distance(cell: pd.DataFrame, edges: Array) -> list[Bin]:
    """What goes on at each goal distance: the bins of `edges` [n + 1] that hold an episode, the nearest first.

    A distance on an inner edge belongs to the farther bin, one on the last edge to the last bin.
    """
    which = np.searchsorted(edges[1:-1], cell["shortest"], side="right")
    return [_bin(cell[which == k]) for k in np.unique(which)]


def _bin(cell: pd.DataFrame) -> Bin:
    carried = cell.loc[decided(cell), "peak_memory_bytes"]
    return Bin(float(cell["shortest"].mean()), share(reached(cell)), float(carried.mean()))
