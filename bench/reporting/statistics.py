"""Intervals and tests: every number of a report says how sure it is.

Words used here
    n       episodes (or pairs of episodes) that a number is made of
    b, c    discordant pairs: episodes that only the agent solved; that only the reference solved
    p       probability of a difference at least as large if there were none
    Z       standard deviations from the mean to either end of a normal distribution's middle 95 %

All intervals have a confidence of 95 %. The bootstrap starts from a fixed seed: the same episodes give the same bits.
SciPy has the same, and the tests hold these against it; but it takes most of a second to load.
"""

from collections.abc import Callable
from itertools import accumulate
from math import sqrt
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fogbench.worlds.types import Array

OUTSIDE = 0.05
"""Probability of what an interval leaves out, half of it at each end."""

Z = NormalDist().inv_cdf(1 - OUTSIDE / 2)
RESAMPLES = 1000
BATCH = 100_000
"""Numbers that the bootstrap draws at a time: what it needs of memory does not grow with the episodes."""


class Estimate(NamedTuple):
    """A number with its interval; NaN where it is not defined."""

    value: float = np.nan
    low: float = np.nan
    high: float = np.nan
    n: int = 0

    def times(self, factor: float) -> "Estimate":
        """The same in another unit; `factor` is positive."""
        return Estimate(self.value * factor, self.low * factor, self.high * factor, self.n)


def share(hits: ArrayLike) -> Estimate:
    """The share of `hits` [n] bool that are true, with the interval of Wilson (1927)."""
    count, n = int(np.sum(hits)), len(np.asarray(hits))
    if n == 0:
        return Estimate()
    value, shrink = count / n, 1 + Z**2 / n
    middle = (value + Z**2 / (2 * n)) / shrink
    width = Z / shrink * sqrt(value * (1 - value) / n + (Z / (2 * n)) ** 2)
    return Estimate(value, middle - width if count else 0.0, middle + width if count < n else 1.0, n)


def mean(values: ArrayLike) -> Estimate:
    """The mean of `values` [n] float, with a bootstrap interval; NaN is left out."""
    numbers = np.array([values], np.float64)  # [1, n]
    return _bootstrap(numbers[:, np.isfinite(numbers[0])], np.mean)


def ratio_of_sums(over: ArrayLike, under: ArrayLike) -> Estimate:
    """The sum of `over` through the sum of `under`, [n] float each, with a bootstrap interval.

    An episode with NaN, or with nothing in `under`, is left out. Whole episodes are drawn, so decisions within an
    episode need not be independent.
    """
    sums = np.array([over, under], np.float64)  # [2, n]
    return _bootstrap(sums[:, np.isfinite(sums[0]) & (sums[1] > 0)], _ratio)


def _ratio(over: Array, under: Array, axis: int = -1) -> Array:
    return np.asarray(over.sum(axis) / under.sum(axis))


def _bootstrap(samples: Array, statistic: Callable[..., Any]) -> Estimate:
    """`statistic` of `samples` [k, n] with the percentile interval of Efron (1979); one episode has none."""
    n = samples.shape[1]
    if n == 0:
        return Estimate()
    value = float(statistic(*samples))
    if n == 1:
        return Estimate(value, n=1)
    rng, batch = np.random.default_rng(0), max(1, BATCH // n)
    drawn = [
        statistic(*samples[:, rng.integers(0, n, (min(batch, RESAMPLES - done), n))], axis=-1)
        for done in range(0, RESAMPLES, batch)
    ]
    low, high = np.quantile(np.concatenate(drawn), [OUTSIDE / 2, 1 - OUTSIDE / 2])
    return Estimate(value, float(low), float(high), n)


def difference(ours: ArrayLike, theirs: ArrayLike) -> Estimate:
    """The mean difference of n paired successes, with the interval of Bonett & Price (2012).

    It is Wald's interval with one episode added to each kind of discordant pair, which keeps it honest where there are
    few or none (recommended by Fagerland, Lydersen & Laake 2014, section 5).

    Args:
        ours: [n] bool, or of several trainings the share of them that succeeded, 0 to 1.
        theirs: the same of whom they are compared with.
    """
    each = np.asarray(ours, np.float64) - np.asarray(theirs, np.float64)  # [n], -1 to 1
    n = len(each)
    if n == 0:
        return Estimate()
    added = np.concatenate([each, [1.0, -1.0]])  # [n + 2]
    width = Z * added.std() / np.sqrt(n + 2)
    low, high = max(-1.0, added.mean() - width), min(1.0, added.mean() + width)
    return Estimate(float(each.mean()), float(low), float(high), n)


def discordant(ours: Array, theirs: Array) -> tuple[int, int]:
    """`(b, c)` of two [n] bool over the same episodes."""
    return int(np.sum(ours & ~theirs)), int(np.sum(~ours & theirs))


def mcnemar(b: int, c: int) -> float:
    """Two-sided mid-p of McNemar's test for paired success (Fagerland, Lydersen & Laake 2013, equation 5)."""
    fewer, n = min(b, c), b + c
    ways = list(accumulate(range(fewer), lambda way, k: way * (n - k) // (k + 1), initial=1))  # binomials, exact
    return (2 * sum(ways) - ways[-1]) / (1 << n)


def holm(p: ArrayLike) -> Array:
    """The p [n] of a table, adjusted so that all its claims together hold (Holm 1979)."""
    p = np.asarray(p, np.float64)
    order = np.argsort(p, kind="stable")
    adjusted = np.empty_like(p)
    adjusted[order] = np.minimum(1, np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1)))
    return adjusted
