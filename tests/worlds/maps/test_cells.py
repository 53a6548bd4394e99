"""Seeing, remembering and misreading, held against exact geometry and plain loops."""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fogbench.worlds.maps.cells import KnownMap, fuse, passable
from fogbench.worlds.maps.sight import hidden, look, misread
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array, Cell, Observation

HALF = Fraction(1, 2)

shapes = st.tuples(st.integers(1, 7), st.integers(1, 7))
maps = shapes.flatmap(lambda shape: arrays(np.bool_, shape))
known_maps = shapes.flatmap(lambda shape: arrays(np.uint8, shape, elements=st.integers(0, 2)))


@st.composite
def places(draw: st.DrawFn, maps: st.SearchStrategy[Array]) -> tuple[Array, int, int]:
    """A map and a cell of it."""
    cells = draw(maps)
    height, width = cells.shape
    return cells, draw(st.integers(0, height - 1)), draw(st.integers(0, width - 1))


def wall(blocked: Array, cell: Cell) -> bool:
    """Whether a cell is blocked; outside the map all are."""
    inside = 0 <= cell[0] < blocked.shape[0] and 0 <= cell[1] < blocked.shape[1]
    return not inside or bool(blocked[cell])


def crosses(a: Cell, b: Cell, cell: Cell) -> bool:
    """Whether the segment between the centres of `a` and `b` crosses the open square of a cell, in exact numbers."""
    low, high = Fraction(0), Fraction(1)  # the segment is a + t * (b - a)
    for begin, end, middle in zip(a, b, cell, strict=True):
        if begin == end:
            if begin != middle:
                return False
            continue
        ends = sorted((Fraction(middle) + side - begin) / (end - begin) for side in (-HALF, HALF))
        low, high = max(low, ends[0]), min(high, ends[1])
    return low < high


def corners(a: Cell, b: Cell) -> list[tuple[Fraction, Fraction]]:
    """The corners of cells that lie on the segment."""
    rows, columns = b[0] - a[0], b[1] - a[1]
    box = (range(min(ends), max(ends)) for ends in zip(a, b, strict=True))
    points = [(r + HALF, c + HALF) for r, c in product(*box)]
    return [(r, c) for r, c in points if (r - a[0]) * columns == (c - a[1]) * rows]


def cut(blocked: Array, a: Cell, b: Cell) -> bool:
    """Whether a wall lies across the segment; through a corner it passes unless both cells beside it are walls."""
    box = (range(min(ends), max(ends) + 1) for ends in zip(a, b, strict=True))
    crossed = {cell for cell in product(*box) if crosses(a, b, cell)}
    if any(wall(blocked, cell) for cell in crossed - {a, b}):
        return True
    for row, column in corners(a, b):
        around = set(product((int(row - HALF), int(row + HALF)), (int(column - HALF), int(column + HALF))))
        if all(wall(blocked, cell) for cell in around - crossed):
            return True
    return False


@given(places(maps), st.integers(1, 4), st.booleans())
def test_look_is_the_truth_in_line_of_sight(place: tuple[Array, int, int], radius: int, occlusion: bool) -> None:
    """Every cell of a view reads as it is, or UNKNOWN exactly where the exact geometry says it is hidden."""
    blocked, row, column = place
    view = look(blocked, row, column, radius, occlusion)
    assert view.shape == (2 * radius + 1, 2 * radius + 1)
    assert view.dtype == np.uint8
    for (r, c), reading in np.ndenumerate(view):
        cell = (row + r - radius, column + c - radius)
        unseen = occlusion and cut(blocked, (row, column), cell)
        assert reading == (UNKNOWN if unseen else BLOCKED if wall(blocked, cell) else FREE)


@given(places(maps), st.integers(-5, 5), st.integers(-5, 5))
def test_sight_is_mutual(place: tuple[Array, int, int], down: int, right: int) -> None:
    """If one cell is hidden from another, so is the other from the one."""
    blocked, row, column = place
    assert hidden(blocked, row, column, down, right) == hidden(blocked, row + down, column + right, -down, -right)


@pytest.mark.parametrize(
    ("walls", "target", "expected"),
    [
        ([(0, 1)], (1, 1), False),
        ([(0, 1), (1, 0)], (1, 1), True),
        ([(1, 1)], (2, 2), True),
        ([(0, 1), (1, 0)], (0, 1), False),
        ([(0, 1)], (1, 2), True),
        ([(1, 1)], (1, 2), True),
        ([(1, 0), (0, 2)], (1, 2), False),
    ],
)
def test_hand_drawn_lines_of_sight(walls: list[Cell], target: Cell, expected: bool) -> None:
    """A single corner lets the line pass, two beside it cut it, and a wall itself is seen."""
    blocked = np.zeros((3, 3), np.bool_)
    for cell in walls:
        blocked[cell] = True
    assert hidden(blocked, 0, 0, *target) is expected


@given(places(maps), st.integers(-3, 3), st.integers(-3, 3))
def test_passable_means_inside_and_free(place: tuple[Array, int, int], down: int, right: int) -> None:
    """Everything outside a map is blocked."""
    blocked, row, column = place
    cell = (row + down, column + right)
    assert passable(blocked, *cell) == (not wall(blocked, cell))


@given(places(known_maps), st.integers(1, 4), st.data())
def test_fuse_writes_a_view_into_the_known_map(place: tuple[Array, int, int], radius: int, data: st.DataObject) -> None:
    """The latest reading wins, UNKNOWN tells nothing, the own cell is free, and `touched` is exactly what changed."""
    known, row, column = place
    side = 2 * radius + 1
    view = data.draw(arrays(np.uint8, (side, side), elements=st.integers(0, 2)))
    expected = known.copy()
    for r, c in np.ndindex(known.shape):
        if abs(r - row) <= radius and abs(c - column) <= radius:
            reading = FREE if (r, c) == (row, column) else view[r - row + radius, c - column + radius]
            expected[r, c] = reading or known[r, c]
    before = known.copy()
    touched = fuse(known, view, row, column)
    assert np.array_equal(known, expected)
    assert touched.dtype == np.int32
    assert touched.tolist() == np.flatnonzero(before != expected).tolist()


def test_a_known_map_starts_unknown_and_remembers() -> None:
    """What has left the view stays as it was last read; what is read again is overwritten."""
    known = KnownMap((2.0, 4.0))
    assert known.cells.tolist() == [[UNKNOWN] * 4] * 2
    wall_ahead = np.array([[2, 2, 2], [2, 1, 2], [2, 1, 1]], np.uint8)
    nothing_new = np.array([[2, 2, 2], [1, 1, 1], [0, 0, 0]], np.uint8)
    assert known.update(Observation(0, (0, 0), wall_ahead, blocked=False)).tolist() == [0, 1, 4, 5]
    assert known.cells.tolist() == [[FREE, BLOCKED, UNKNOWN, UNKNOWN], [FREE, FREE, UNKNOWN, UNKNOWN]]
    assert known.update(Observation(1, (0, 2), nothing_new, blocked=False)).tolist() == [1, 2, 3]
    assert known.cells.tolist() == [[FREE, FREE, FREE, FREE], [FREE, FREE, UNKNOWN, UNKNOWN]]


@given(
    arrays(np.uint8, (5, 5), elements=st.integers(0, 2)),
    arrays(np.bool_, (5, 5)),
)
def test_misread_exchanges_free_and_blocked(view: Array, wrong: Array) -> None:
    """A wrong reading is the opposite one, UNKNOWN stays, and the true view is left alone."""
    before = view.copy()
    opposite = {UNKNOWN: UNKNOWN, FREE: BLOCKED, BLOCKED: FREE}
    again = misread(view, wrong)
    assert again.dtype == np.uint8
    for cell, reading in np.ndenumerate(before):
        assert again[cell] == (opposite[int(reading)] if wrong[cell] else reading)
    assert np.array_equal(view, before)
