"""Intervals and tests, against their definitions and against numbers from the literature."""

from itertools import product
from math import comb, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from fogbench.bench.reporting.statistics import Estimate, difference, holm, mcnemar, mean, ratio_of_sums, share

Z = 1.959963984540054
HITS = st.lists(st.booleans(), min_size=1, max_size=60)
PROBABILITIES = st.lists(st.floats(0, 1), min_size=1, max_size=12)


def bools(yes: int, no: int) -> np.ndarray:
    """`yes` times true, then `no` times false."""
    return np.array([True] * yes + [False] * no)


@pytest.mark.parametrize(
    ("yes", "n", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0000, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_the_interval_of_a_share_is_that_of_newcombes_table(yes: int, n: int, low: float, high: float) -> None:
    """Newcombe 1998, table I, method 3 (Wilson without continuity correction)."""
    assert share(bools(yes, n - yes)) == pytest.approx((yes / n, low, high, n), abs=5e-5)


@given(HITS)
def test_the_ends_of_wilsons_interval_solve_the_equation_that_defines_it(hits: list[bool]) -> None:
    """At both ends the observed share is z standard errors away, with the standard error of the end."""
    value, low, high, n = share(np.array(hits))
    for end in (low, high):
        assert (value - end) ** 2 == pytest.approx(Z**2 * end * (1 - end) / n, abs=1e-9)
    assert 0 <= low <= value + 1e-12
    assert value - 1e-12 <= high <= 1


@given(HITS)
def test_the_interval_of_a_share_is_that_of_scipy(hits: list[bool]) -> None:
    """Also where all or none are hits."""
    interval = stats.binomtest(sum(hits), len(hits)).proportion_ci(0.95, method="wilson")
    assert share(hits)[1:3] == pytest.approx((interval.low, interval.high), abs=1e-15)


def test_nothing_has_no_estimate() -> None:
    """Without an episode there is no number, no interval, and n is 0."""
    nobody = bools(0, 0)
    for estimate in (share([]), mean([]), mean([np.nan]), ratio_of_sums([1.0], [0.0]), difference(nobody, nobody)):
        assert np.isnan(estimate[:3]).all()
        assert estimate.n == 0


def test_one_episode_has_no_bootstrap_interval() -> None:
    """One value tells nothing of how far the next would be from it."""
    estimate = mean([3.0])
    assert (estimate.value, estimate.n) == (3.0, 1)
    assert np.isnan([estimate.low, estimate.high]).all()


def test_the_bootstrap_interval_is_that_of_all_resamples() -> None:
    """With six episodes all 6^6 resamples can be listed; 1000 of them drawn come close to their percentiles."""
    over, under = np.array([1.0, 4.0, 2.0, 7.0, 3.0, 5.0]), np.array([2.0, 3.0, 5.0, 4.0, 6.0, 1.0])
    chosen = np.array(list(product(range(6), repeat=6)))  # [6^6, 6]
    low, high = np.percentile(over[chosen].sum(1) / under[chosen].sum(1), [2.5, 97.5])
    assert ratio_of_sums(over, under) == pytest.approx((22 / 21, low, high, 6), rel=0.05)


@pytest.mark.parametrize("n", [2, 50, 300, 12_345])
def test_the_bootstrap_interval_is_that_of_scipy(n: int) -> None:
    """For one sample and for two, in as many batches as it takes: the same draws give the same interval."""
    over, under = np.random.default_rng(n).random((2, n)) + 0.5
    for estimate, samples, statistic in (
        (mean(over), (over,), np.mean),
        (ratio_of_sums(over, under), (over, under), lambda a, b, axis: a.sum(axis) / b.sum(axis)),
    ):
        interval = stats.bootstrap(
            samples, statistic, paired=True, vectorized=True, n_resamples=1000, batch=max(1, 100_000 // n),
            method="percentile", rng=0,
        ).confidence_interval  # fmt: skip
        assert estimate[1:3] == pytest.approx((interval.low, interval.high), rel=1e-14)


def test_the_mean_leaves_out_what_is_not_a_number() -> None:
    """NaN is neither counted nor averaged."""
    estimate = mean([1.0, np.nan, 3.0])
    assert (estimate.value, estimate.n) == (2.0, 2)


def test_the_ratio_of_sums_leaves_out_episodes_without_a_denominator() -> None:
    """An episode in which nothing was judged adds to neither sum."""
    estimate = ratio_of_sums([1, 5, 2], [4, 0, 6])
    assert (estimate.value, estimate.n) == (0.3, 2)


@given(st.lists(st.integers(0, 9), min_size=2, max_size=30))
def test_the_bootstrap_interval_contains_the_mean(values: list[int]) -> None:
    """The estimate lies in its own interval, and the interval inside the values."""
    value, low, high, _ = mean(values)
    assert min(values) - 1e-9 <= low <= value + 1e-9
    assert value - 1e-9 <= high <= max(values) + 1e-9


def test_the_bootstrap_gives_the_same_bits() -> None:
    """Its seed is its own: two calls agree bit for bit."""
    values = np.random.default_rng(7).random(50)
    assert mean(values) == mean(values)


def test_the_difference_of_paired_shares_is_that_of_the_definition() -> None:
    """Bonett & Price 2012 on 1 against 7 discordant pairs of 21, written out."""
    ours, theirs = bools(1, 20), np.roll(bools(7, 14), 1)
    more, less = 2 / 23, 8 / 23
    width = Z * sqrt((more + less - (more - less) ** 2) / 23)
    assert difference(ours, theirs) == pytest.approx((-6 / 21, more - less - width, more - less + width, 21))


@given(st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=40))
def test_the_interval_of_a_difference_contains_it_and_turns_with_it(pairs: list[tuple[bool, bool]]) -> None:
    """The estimate lies inside [-1, 1] and in its interval; swapping the two changes the sign of all three."""
    ours, theirs = np.array(pairs).T
    value, low, high, n = difference(ours, theirs)
    assert -1 <= low <= value <= high <= 1
    assert difference(theirs, ours) == pytest.approx((-value, -high, -low, n))


def test_mid_p_is_that_of_fagerlands_example() -> None:
    """Fagerland, Lydersen & Laake 2013: 1 against 7 discordant pairs, mid-p 0.039 (exact 0.070)."""
    assert mcnemar(1, 7) == pytest.approx(0.039, abs=5e-4)


@given(st.integers(0, 60), st.integers(0, 60))
def test_mid_p_counts_the_observed_table_half_on_each_side(b: int, c: int) -> None:
    """Twice (the probability of fewer, plus half that of as few), by summing binomial coefficients."""
    n, fewer = b + c, min(b, c)
    expected = (2 * sum(comb(n, k) for k in range(fewer)) + comb(n, fewer)) / 2**n
    assert mcnemar(b, c) == pytest.approx(expected)
    assert mcnemar(b, c) == mcnemar(c, b)
    assert 0 <= mcnemar(b, c) <= 1


@given(st.integers(0, 5000), st.integers(0, 5000))
def test_mid_p_of_many_pairs_is_that_of_scipy(b: int, c: int) -> None:
    """By the distribution of scipy."""
    below, at = stats.binom.cdf(min(b, c), b + c, 0.5), stats.binom.pmf(min(b, c), b + c, 0.5)
    assert mcnemar(b, c) == pytest.approx(2 * below - at, rel=1e-9, abs=1e-300)


def test_holm_adjusts_a_table_by_hand() -> None:
    """0.005 x 4, 0.01 x 3, 0.03 x 2, and 0.04 x 1 raised to the one before."""
    assert holm([0.01, 0.04, 0.03, 0.005]).tolist() == pytest.approx([0.03, 0.06, 0.06, 0.02])


@given(PROBABILITIES)
def test_holm_keeps_the_order_and_never_makes_a_claim_stronger(p: list[float]) -> None:
    """Adjusted p are at least p, at most 1 and Bonferroni's, ordered as p, and follow the step-down definition."""
    adjusted = holm(p)
    ordered = sorted(p)
    for value, holms in zip(p, adjusted, strict=True):
        expected = min(1, max((len(p) - k) * each for k, each in enumerate(ordered) if each <= value))
        assert holms == pytest.approx(expected)
        assert value - 1e-12 <= holms <= min(1, len(p) * value) + 1e-12
    assert (np.diff(adjusted[np.argsort(p, kind="stable")]) >= 0).all()


def test_an_empty_table_has_nothing_to_adjust() -> None:
    """A scenario with one agent compares nobody."""
    assert holm([]).tolist() == []


def test_an_estimate_in_another_unit_keeps_its_n() -> None:
    """Value and interval are scaled, n is not."""
    assert Estimate(0.5, 0.25, 0.75, 8).times(100) == Estimate(50, 25, 75, 8)
