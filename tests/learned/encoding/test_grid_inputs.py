"""What a network sees, against loops over the cells of the whole map."""

from typing import Any

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from fogbench.learned.encoding.grid_inputs import STILL, Known, encode
from fogbench.learned.encoding.grid_sizes import COMPASS, SIGHT, Frame
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array


def knowledge(seed: int, batch: int, extent: tuple[int, int], side: int) -> Known:
    """Views of `side` cells, or known maps if it is 0, of some agents on maps of an extent."""
    rng = np.random.default_rng(seed)
    places, goals = rng.integers(0, extent, (2, batch, 2))  # [B, 2] each
    shape = (side, side) if side else extent
    cells = rng.choice([UNKNOWN, FREE, BLOCKED], (batch, *shape)).astype(np.uint8)
    corners = places - side // 2 if side else np.zeros_like(places)
    return Known(cells, corners, places, goals, rng.integers(0, 5, batch), rng.random(batch) < 0.5)


def slowly(known: Known, b: int, rows: Any, columns: Any) -> Array:
    """The image of one sample over the map's rows and columns that are named, cell by cell from the definition."""
    image = np.zeros((3, len(rows), len(columns)), np.float32)
    goal = min(max(known.goals[b, 0], rows[0]), rows[-1]), min(max(known.goals[b, 1], columns[0]), columns[-1])
    for r, row in enumerate(rows):
        for c, column in enumerate(columns):
            i, j = row - known.corners[b, 0], column - known.corners[b, 1]
            inside = 0 <= i < known.cells.shape[1] and 0 <= j < known.cells.shape[2]
            reading = known.cells[b, i, j] if inside else UNKNOWN
            if (row, column) == tuple(known.places[b]):
                reading = FREE
            image[:, r, c] = reading == FREE, reading == BLOCKED, (row, column) == goal
    return image


@given(st.integers(0, 10**6), st.integers(1, 4), st.sampled_from([0, 1, 3, 7, 11]), st.sampled_from([1, 5, 8, 11]))
def test_windows_are_the_cells_around(seed: int, batch: int, side: int, size: int) -> None:
    """A window shows what is known of the cells around the agent; all else is unknown, the goal at its nearest cell."""
    known = knowledge(seed, batch, (9, 12), side)
    inputs = encode(known, Frame((size, size + 2), centred=True))
    for b, (row, column) in enumerate(known.places):
        top, left = row - size // 2, column - (size + 2) // 2
        expected = slowly(known, b, range(top, top + size), range(left, left + size + 2))
        assert np.array_equal(inputs.image[b].numpy(), expected)
        assert divmod(inputs.cells[b].item(), size + 2) == (size // 2, (size + 2) // 2)


@given(st.integers(0, 10**6), st.integers(1, 4), st.sampled_from([0, 3, 7]))
def test_maps_are_all_cells(seed: int, batch: int, side: int) -> None:
    """The whole map shows every cell where it is, and the agent's own place."""
    known = knowledge(seed, batch, (9, 12), side)
    inputs = encode(known, Frame((9, 12), centred=False))
    for b in range(batch):
        assert np.array_equal(inputs.image[b].numpy(), slowly(known, b, range(9), range(12)))
        assert divmod(inputs.cells[b].item(), 12) == tuple(known.places[b])


@given(st.integers(0, 10**6), st.sampled_from([0, 3, 7, 11]))
def test_sight_is_seven_by_seven(seed: int, side: int) -> None:
    """A sight is the same, whatever the frame; a larger sensor is cut, a smaller one leaves the rest unknown."""
    known = knowledge(seed, 3, (9, 12), side)
    window, whole = (encode(known, Frame((9, 12), centred)) for centred in (True, False))
    assert torch.equal(window.sight, whole.sight)
    for b, (row, column) in enumerate(known.places):
        around = [range(middle - SIGHT, middle + SIGHT + 1) for middle in (row, column)]
        assert np.array_equal(window.sight[b].numpy(), slowly(known, b, *around))


def test_a_compass_by_hand() -> None:
    """Sign, logarithm and clamped size of both offsets; the last move; whether an obstacle stopped it."""
    places, goals = np.array([[4, 4], [0, 9]]), np.array([[6, 0], [0, 9]])
    cells, corners = np.zeros((2, 3, 3), np.uint8), places - 1
    known = Known(cells, corners, places, goals, np.array([2, STILL]), np.array([True, False]))
    compass = encode(known, Frame((5, 5), centred=True)).compass
    expected = torch.zeros(2, COMPASS)
    expected[0, :6] = torch.tensor([1, -1, np.log(3), np.log(5), 2 / 3, -1])
    expected[0, [6 + 2, 11]] = 1
    expected[1, 6 + STILL] = 1
    assert torch.allclose(compass, expected)


@pytest.mark.parametrize("far", [65, 10_000])
def test_beyond_the_horizon_all_goals_look_alike(far: int) -> None:
    """A goal 64 cells off and one farther off in the same direction give the same inputs, one nearer does not."""
    goals = np.array([[63, 0], [64, 0], [far, 0]])
    places, cells = np.zeros((3, 2), np.int64), np.zeros((3, 3, 3), np.uint8)
    known = Known(cells, places - 1, places, goals, np.full(3, STILL), np.zeros(3, np.bool_))
    image, _, sight, compass = encode(known, Frame((5, 5), centred=True))
    assert all(torch.equal(told[1], told[2]) for told in (image, sight, compass))
    assert not torch.equal(compass[0], compass[1])


@given(st.integers(0, 10**6), st.sampled_from([0, 7]), st.booleans())
def test_a_batch_is_its_samples(seed: int, side: int, centred: bool) -> None:
    """Each sample of a batch is encoded as it would be alone."""
    known = knowledge(seed, 5, (9, 12), side)
    together = encode(known, Frame((9, 12), centred))
    for b in range(5):
        alone = encode(Known(*(part[b : b + 1] for part in known)), Frame((9, 12), centred))
        assert all(torch.equal(a[0], t[b]) for a, t in zip(alone, together, strict=True))
