"""Rectangles of cells, and what a disc touches."""

from math import hypot

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fogbench.worlds.robot.walls import raised, rectangles, touches
from fogbench.worlds.types import BLOCKED, FREE

SEEDS = st.integers(0, 2**32 - 1)


def test_a_map_is_turned_over_and_split() -> None:
    """Row 0 of a family is the upper one; a cell becomes a square of cells."""
    cells = raised(np.array([[True, False], [False, False]]), 2)
    assert (cells == BLOCKED).tolist() == [
        [False] * 4,
        [False] * 4,
        [True, True, False, False],
        [True, True, False, False],
    ]


@given(seed=SEEDS, share=st.sampled_from([0.0, 0.3, 0.8, 1.0]))
def test_rectangles_cover_all_blocked_cells_once(seed: int, share: float) -> None:
    """And nothing else."""
    rng = np.random.default_rng(seed)
    cells = np.where(rng.random(rng.integers(1, 20, 2)) < share, BLOCKED, FREE).astype(np.uint8)
    covered = np.zeros(cells.shape, np.int64)
    for row, column, rows, columns in rectangles(cells):
        covered[row : row + rows, column : column + columns] += 1
    assert np.array_equal(covered, cells == BLOCKED)


def test_a_block_is_one_rectangle() -> None:
    """However large."""
    assert rectangles(np.full((40, 30), BLOCKED, np.uint8)).tolist() == [[0, 0, 40, 30]]


@given(seed=SEEDS, x=st.floats(0, 8), y=st.floats(0, 8), radius=st.floats(0.1, 3))
def test_a_disc_touches_what_is_nearer_than_its_radius(seed: int, x: float, y: float, radius: float) -> None:
    """By the nearest point of each blocked cell, and the border."""
    cells = np.where(np.random.default_rng(seed).random((8, 8)) < 0.1, BLOCKED, FREE).astype(np.uint8)
    near = [min(x, y, 8 - x, 8 - y)]
    for row, column in np.argwhere(cells == BLOCKED).tolist():
        near.append(hypot(x - min(max(x, column), column + 1), y - min(max(y, row), row + 1)))
    if abs(min(near) - radius) > 1e-9:
        assert touches(cells, x, y, radius) == (min(near) < radius)
