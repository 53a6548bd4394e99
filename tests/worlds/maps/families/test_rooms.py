"""Rooms."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.ndimage import find_objects, label
from scipy.stats import chisquare

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.rooms import Rooms
from fogbench.worlds.types import Array

CONDITIONS = GridConditions.model_validate({"budget": {"steps": 60}})
SEEDS = st.integers(0, 2**32 - 1)


def draw(seed: int, size: int, rooms: tuple[int, int], doors: int) -> Array:
    """Rooms with a fixed number of doors; the same seed puts the walls at the same places."""
    family = Rooms(size=size, rooms=rooms, doors=(doors, doors))
    return family.draw(np.random.default_rng(seed), CONDITIONS).blocked


@given(seed=SEEDS, rooms=st.integers(1, 5), spare=st.integers(1, 20))
def test_without_doors_the_rooms_are_closed_rectangles(seed: int, rooms: int, spare: int) -> None:
    """As many rectangles as rooms, none narrower than half the mean, and walls one cell thick between them."""
    size = 2 * rooms - 1 + spare
    blocked = draw(seed, size, (rooms, rooms), 0)
    names, count = label(~blocked)
    assert count == rooms**2
    for name, (rows, columns) in enumerate(find_objects(names), 1):
        assert (names[rows, columns] == name).all()
        assert min(rows.stop - rows.start, columns.stop - columns.start) >= max(1, (size - rooms + 1) // rooms // 2)
    assert (~blocked).sum() == (size - rooms + 1) ** 2


@given(seed=SEEDS, doors=st.integers(1, 4))
def test_every_pair_of_neighbours_shares_its_doors(seed: int, doors: int) -> None:
    """Each opened cell joins two rooms, and each two neighbours share `doors`, or as many as their wall has cells."""
    closed, opened = draw(seed, 20, (1, 5), 0), draw(seed, 20, (1, 5), doors)
    names, count = label(~closed)
    walls, found = Counter[frozenset[int]](), Counter[frozenset[int]]()
    padded = np.pad(names, 1)
    for r, c in np.argwhere(closed) + 1:
        for a, b in ((padded[r - 1, c], padded[r + 1, c]), (padded[r, c - 1], padded[r, c + 1])):
            if a and b:
                walls[frozenset((int(a), int(b)))] += 1
                found[frozenset((int(a), int(b)))] += int(not opened[r - 1, c - 1])
    assert found == {pair: min(doors, length) for pair, length in walls.items()}
    assert sum(found.values()) == (closed & ~opened).sum()
    assert label(~opened)[1] == 1
    assert count == 1 or walls


def test_numbers_of_rooms_are_uniform() -> None:
    """The rooms in a row and those in a column are drawn apart, each number equally often."""
    shapes = np.zeros((4, 4), int)
    for seed in range(900):
        closed = draw(seed, 15, (1, 3), 0)
        shapes[1 + closed.all(1).sum(), 1 + closed.all(0).sum()] += 1
    assert shapes.sum() == shapes[1:, 1:].sum()
    assert chisquare(shapes[1:, 1:].ravel()).pvalue > 0.001


def test_doors_are_uniform_over_their_wall() -> None:
    """Where the walls of four equal rooms cross in the middle, a wall's one door is equally often at either cell."""
    cross = np.zeros((5, 5), bool)
    cross[2] = cross[:, 2] = True
    equal = [seed for seed in range(1500) if np.array_equal(draw(seed, 5, (2, 2), 0), cross)]
    doors = np.sum([cross & ~draw(seed, 5, (2, 2), 1) for seed in equal], axis=0)  # [5, 5]
    assert np.sum(doors) == 4 * len(equal)
    assert chisquare(np.concatenate([doors[2, [0, 1, 3, 4]], doors[[0, 1, 3, 4], 2]])).pvalue > 0.001


@pytest.mark.parametrize("rooms", [3, 4])
def test_rooms_that_do_not_fit_are_refused(rooms: int) -> None:
    """The error says the least size that would do."""
    with pytest.raises(ValidationError) as error:
        Rooms(size=4, rooms=(1, rooms), doors=(1, 1))
    expected = f"Value error, a size from {2 * rooms - 1}, for {rooms} rooms in a row"
    assert [mistake["msg"] for mistake in error.value.errors()] == [expected]
