"""How difficult a map is."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from fogbench.worlds.maps.covariates import COVARIATES, covariates
from fogbench.worlds.types import Array


def plain(blocked: Array) -> tuple[float, float, float]:
    """Density, dead ends and openness, counted cell by cell."""
    free = {(int(r), int(c)) for r, c in np.argwhere(~blocked)}
    around = {(r, c): [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (r + i, c + j) in free] for r, c in free}
    ends = sum(sum(abs(i) + abs(j) == 1 for i, j in near) == 1 for near in around.values())
    neighbours = sum(len(near) - 1 for near in around.values())
    return 1 - len(free) / blocked.size, 100 * ends / max(1, len(free)), neighbours / (8 * max(1, len(free)))


@settings(max_examples=100, deadline=None)
@given(arrays(bool, array_shapes(min_dims=2, max_dims=2, max_side=8), elements=st.booleans()))
def test_they_are_what_a_plain_loop_counts(blocked: Array) -> None:
    """Density, dead ends and openness equal a count by sets of cells."""
    told = covariates(blocked, 1, 1)
    assert (told["density"], told["dead_ends"], told["openness"]) == pytest.approx(plain(blocked))


def test_by_hand() -> None:
    """A corridor of three cells beside a wall of three, with a task twice as long as the straight line."""
    told = covariates(np.array([[0, 0, 0], [1, 1, 1]], bool), straight=2, optimum=4)
    assert told == {
        "density": 0.5,
        "detour": 2.0,
        "dead_ends": pytest.approx(200 / 3),
        "openness": pytest.approx(4 / 24),
    }
    assert tuple(told) == COVARIATES
