"""Simple obstacles."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import find_objects, label
from scipy.stats import chisquare

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.blobs import Blobs, covered
from fogbench.worlds.types import Array

CONDITIONS = GridConditions.model_validate({"budget": {"steps": 60}})


def draws(family: Blobs, count: int) -> list[Array]:
    """Maps, one after the other from one generator."""
    rng = np.random.default_rng(0)
    return [family.draw(rng, CONDITIONS).blocked for _ in range(count)]


def test_counts_sides_and_places_are_uniform() -> None:
    """On a map so large that rectangles rarely meet: counts, both sides, and places are uniform in their ranges."""
    counts, sides, places = np.zeros(6, int), np.zeros((5, 5), int), np.zeros((2, 2), int)
    for blocked in draws(Blobs(size=300, obstacles=(2, 5), obstacle_size=(2, 4)), 500):
        boxes = find_objects(label(blocked, np.ones((3, 3)))[0])
        counts[min(len(boxes), 5)] += 1
        for rows, columns in boxes:
            places[rows.start // 150, columns.start // 150] += 1
            if rows.stop < 300 and columns.stop < 300 and max(rows.stop - rows.start, columns.stop - columns.start) < 5:
                sides[rows.stop - rows.start, columns.stop - columns.start] += 1
    assert sides.sum() == sides[2:, 2:].sum()
    assert chisquare(counts[2:]).pvalue > 0.001
    assert chisquare(sides[2:, 2:].ravel()).pvalue > 0.001
    assert chisquare(places.ravel()).pvalue > 0.001


def test_rectangles_are_cut_at_the_border() -> None:
    """A rectangle larger than the map fills it from its upper left corner on, which is uniform over the cells."""
    corners = np.zeros((4, 4), int)
    for blocked in draws(Blobs(size=4, obstacles=(1, 1), obstacle_size=(9, 9)), 1600):
        r, c = np.argwhere(blocked)[0]
        corners[r, c] += 1
        assert blocked[r:, c:].all()
        assert blocked.sum() == (4 - r) * (4 - c)
    assert chisquare(corners.ravel()).pvalue > 0.001


def test_no_obstacles_leave_an_empty_map() -> None:
    """Both ends of `obstacles` are included, also 0."""
    blocked = draws(Blobs(size=8, obstacles=(0, 1), obstacle_size=(1, 1)), 64)
    assert {int(map_.sum()) for map_ in blocked} == {0, 1}


@given(st.integers(2, 12), st.lists(st.tuples(*[st.integers(0, 11)] * 2, *[st.integers(1, 20)] * 2)))
def test_rectangles_cover_what_slices_cover(size: int, rectangles: list[tuple[int, int, int, int]]) -> None:
    """Counted by where they begin and end, or filled one by one: the same cells are blocked."""
    inside = np.array([each for each in rectangles if max(each[:2]) < size], np.int64).reshape(-1, 4)
    blocked = np.zeros((size, size), np.bool_)
    for r, c, rows, columns in inside.tolist():
        blocked[r : r + rows, c : c + columns] = True
    np.testing.assert_array_equal(covered(size, inside[:, :2], inside[:, 2:]), blocked)


def test_there_are_no_more_rectangles_than_cells() -> None:
    """A million on 64 cells would be drawn for every map, and fill it."""
    with pytest.raises(ValueError, match="at most 64 rectangles, one for each cell"):
        Blobs(size=8, obstacles=(0, 65), obstacle_size=(1, 2))
