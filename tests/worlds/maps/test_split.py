"""Cutting a length at random places."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chisquare

from fogbench.worlds.maps.split import split


@given(st.integers(0, 50), st.integers(1, 8), st.integers(0, 5), st.integers(0, 2**32 - 1))
def test_the_parts_make_up_the_whole(spare: int, parts: int, least: int, seed: int) -> None:
    """There are as many parts as asked for, none is below the least, and they sum to the total."""
    cut = split(parts * least + spare, parts, least, np.random.default_rng(seed))
    assert (len(cut), sum(cut)) == (parts, parts * least + spare)
    assert min(cut) >= least


def test_a_single_cut_is_uniform() -> None:
    """Two parts of 7 cells, 1 at least, fall in each of the six ways equally often."""
    rng = np.random.default_rng(0)
    firsts = [split(7, 2, 1, rng)[0] for _ in range(3000)]
    counts = np.bincount(firsts, minlength=7)  # [7]
    assert counts[0] == 0
    assert chisquare(counts[1:]).pvalue > 0.001
