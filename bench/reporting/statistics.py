"""Intervals and tests: every number of a report says how sure it is.

Words used here
    n       episodes (or pairs of episodes) that a number is made of
    b, c    discordant pairs: episodes that only the agent solved; that only the reference solved
    p       probability of a difference at least as large if there were none

All intervals have a confidence of 95 %. The bootstrap starts from a fixed seed: the same episodes give the same bits.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from fogbench.worlds.types import Array

CONFIDENCE = 0.95
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
    interval = stats.binomtest(count, n).proportion_ci(CONFIDENCE, method="wilson")
    return Estimate(count / n, interval.low, interval.high, n)


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
    drawn = stats.bootstrap(
        samples,
        statistic,
        paired=True,
        vectorized=True,
        n_resamples=RESAMPLES,
        batch=max(1, BATCH // n),
        confidence_level=CONFIDENCE,
        method="percentile",
        rng=0,
    )
    return Estimate(value, float(drawn.confidence_interval.low), float(drawn.confidence_interval.high), n)


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
    width = stats.norm.ppf((1 + CONFIDENCE) / 2) * added.std() / np.sqrt(n + 2)
    low, high = max(-1.0, added.mean() - width), min(1.0, added.mean() + width)
    return Estimate(float(each.mean()), float(low), float(high), n)


def discordant(ours: Array, theirs: Array) -> tuple[int, int]:
    """`(b, c)` of two [n] bool over the same episodes."""
    return int(np.sum(ours & ~theirs)), int(np.sum(~ours & theirs))


def mcnemar(b: int, c: int) -> float:
    """Two-sided mid-p of McNemar's test for paired success (Fagerland, Lydersen & Laake 2013, equation 5)."""
    fewer, n = min(b, c), b + c
    return min(1.0, float(2 * stats.binom.cdf(fewer, n, 0.5) - stats.binom.pmf(fewer, n, 0.5)))


def holm(p: ArrayLike) -> Array:
    """The p [n] of a table, adjusted so that all its claims together hold (Holm 1979)."""
    p = np.asarray(p, np.float64)
    order = np.argsort(p, kind="stable")
    adjusted = np.empty_like(p)
    adjusted[order] = np.minimum(1, np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1)))
    return adjusted
