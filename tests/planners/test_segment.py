"""Motions over a grid, held against fractions."""

import math
from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fogbench.planners.segment import PARTS, clear, walk
from fogbench.worlds.types import BLOCKED, Array

HEIGHT, WIDTH = 5, 7

Point = tuple[float, float]


def axis(side: int) -> st.SearchStrategy[float]:
    """Coordinates inside a map: any, or such that motions run through corners."""
    anywhere = st.floats(-0.5, side - 0.5, exclude_max=True)
    return st.one_of(st.integers(0, side - 1).map(float), anywhere)


points = st.tuples(axis(HEIGHT), axis(WIDTH))
maps = st.lists(st.booleans(), min_size=HEIGHT * WIDTH, max_size=HEIGHT * WIDTH).map(
    lambda cells: np.array(cells).reshape(HEIGHT, WIDTH) * np.uint8(BLOCKED)
)


def middle(point: Point) -> tuple[Fraction, Fraction]:
    """What a point stands for."""
    row, column = (Fraction(2 * math.floor((x + 0.5) * PARTS) + 1, 2 * PARTS) - Fraction(1, 2) for x in point)
    return row, column


def touches(start: Point, end: Point, cell: tuple[int, int]) -> bool:
    """Whether the motion has a point in the closed square of a cell: Liang and Barsky's clipping, in fractions."""
    enter, leave = Fraction(0), Fraction(1)
    for a, b, centre in zip(middle(start), middle(end), cell, strict=True):
        low, high = centre - Fraction(1, 2) - a, centre + Fraction(1, 2) - a
        if a == b:
            if low > 0 or high < 0:
                return False
            continue
        first, last = sorted((low / (b - a), high / (b - a)))
        enter, leave = max(enter, first), min(leave, last)
    return enter <= leave


def supercover(start: Point, end: Point) -> set[int]:
    """Flat indices of all cells that a motion touches."""
    return {r * WIDTH + c for r in range(HEIGHT) for c in range(WIDTH) if touches(start, end, (r, c))}


def places(cells: Array, width: int) -> Array:
    """[n, 2], rows and columns of flat indices."""
    return np.stack(np.divmod(cells.astype(np.int64), width), axis=1)


@given(points, points)
def test_a_walk_goes_from_cell_to_neighbour_over_touched_cells(start: Point, end: Point) -> None:
    """It leads from the start's cell to the end's without a detour, and leaves out only the far side of corners."""
    cells = walk(np.zeros((HEIGHT, WIDTH), np.uint8), *start, *end)
    way = places(cells, WIDTH)
    assert way[0].tolist() == [math.floor(x + Fraction(1, 2)) for x in middle(start)]
    assert way[-1].tolist() == [math.floor(x + Fraction(1, 2)) for x in middle(end)]
    assert len(cells) == 1 + np.abs(way[-1] - way[0]).sum()
    assert (np.abs(np.diff(way, axis=0)).sum(axis=1) == 1).all()
    touched = supercover(start, end)
    assert set(cells.tolist()) <= touched
    forward = np.sign(way[-1] - way[0])
    corners = [before + after - here for before, here, after in zip(way, way[1:], way[2:], strict=False)]
    beside = {r * WIDTH + c for r, c in corners if touches(start, end, (r, c))}
    assert touched - set(cells.tolist()) <= beside
    assert (np.diff(way, axis=0) @ forward == 1).all()


@given(maps, points, points)
def test_a_motion_is_clear_when_no_touched_cell_is_blocked(known: Array, start: Point, end: Point) -> None:
    """Corners count with all four cells, whichever way the motion goes; a motion that is not clear has no walk."""
    expected = all(known.flat[cell] != BLOCKED for cell in supercover(start, end))
    assert clear(known, *start, *end) is expected
    assert clear(known, *end, *start) is expected
    assert (len(walk(known, *start, *end)) > 0) is expected


def test_a_diagonal_takes_one_side_of_each_corner() -> None:
    """From centre to centre through two corners, the cell in the next row comes first; either side cell cuts it."""
    known = np.zeros((3, 3), np.uint8)
    assert walk(known, 0.0, 0.0, 2.0, 2.0).tolist() == [0, 3, 4, 7, 8]
    assert walk(known, 2.0, 2.0, 0.0, 0.0).tolist() == [8, 5, 4, 1, 0]
    for side in (1, 3, 5, 7):
        known.flat[side] = BLOCKED
        assert not clear(known, 0.0, 0.0, 2.0, 2.0)
        known.flat[side] = 0


@given(st.floats(-0.5, 2**14 - 0.5, exclude_max=True))
def test_no_point_stands_on_a_border(x: float) -> None:
    """Its middle is less than a part away, and strictly inside one cell; a centre stands for itself."""
    row, column = middle((x, round(x)))
    assert abs(row - Fraction(x)) <= Fraction(1, PARTS)
    assert (row + Fraction(1, 2)).denominator != 1
    assert column == round(x)


def test_the_largest_maps_stay_exact() -> None:
    """Across 2**14 x 2**14 cells, every cell of the walk is touched: corners of it lie on both sides of the motion."""
    side = 2**14
    known = np.lib.stride_tricks.as_strided(np.zeros(1, np.uint8), (side, side), (0, 0))
    way = places(walk(known, 0.0, 0.0, side - 1.0, side - 2.0), side)
    assert len(way) == 2 * side - 2
    corners = 2 * way[:, None, :] + np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]])  # [n, 4, 2], half cells
    sides = corners[..., 0] * (side - 2) - corners[..., 1] * (side - 1)  # [n, 4]
    assert (sides.min(axis=1) <= 0).all()
    assert (sides.max(axis=1) >= 0).all()
