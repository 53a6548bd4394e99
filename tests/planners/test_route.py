"""A path that is followed until something cuts it; maps are 2 x 3, cells numbered in rows from 0 to 5."""

import numpy as np
import pytest

from fogbench.planners.route import Route
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array, Cell, Move

OPEN = np.full((2, 3), FREE, np.uint8)  # [H, W]
ROUND = [0, 1, 2, 5, 4, 3]  # right, right, down, left, left


def route(cells: list[int], width: int = 3) -> Route:
    """A route over flat indices."""
    return Route(np.array(cells, np.int32), width)


def but(cell: Cell, value: int) -> Array:
    """The open map but for one cell."""
    known = OPEN.copy()
    known[cell] = value
    return known


def test_a_route_is_followed_to_its_end_and_no_further() -> None:
    """The moves are those between its cells, in order, then None."""
    way = route(ROUND)
    moves = [way.move(divmod(cell, 3), OPEN) for cell in ROUND]
    assert moves == [Move.RIGHT, Move.RIGHT, Move.DOWN, Move.LEFT, Move.LEFT, None]


def test_a_route_leads_up_and_down_a_map_of_one_column() -> None:
    """Where a row and a column are one step of the index, the move is still that of the row."""
    known = np.zeros((2, 1), np.uint8)  # [H, W]
    assert route([0, 1], width=1).move((0, 0), known) is Move.DOWN
    assert route([1, 0], width=1).move((1, 0), known) is Move.UP


def test_a_slip_in_place_repeats_the_move() -> None:
    """An agent that did not get on is told the same move again, and the next one once it did."""
    way = route(ROUND)
    assert [way.move((0, 0), OPEN), way.move((0, 0), OPEN), way.move((0, 1), OPEN)] == [Move.RIGHT] * 3
    assert way.move((0, 1), OPEN) is Move.RIGHT
    assert way.move((0, 2), OPEN) is Move.DOWN


@pytest.mark.parametrize("place", [(1, 0), (1, 1), (0, 2)])
def test_off_the_route_there_is_no_move(place: Cell) -> None:
    """A cell that is neither the last one nor the next is off the route, even if it lies further on."""
    assert route(ROUND).move(place, OPEN) is None


def test_a_blocked_cell_anywhere_ahead_cuts_the_route() -> None:
    """The goal itself counts as ahead."""
    assert route(ROUND).move((0, 0), but((1, 0), BLOCKED)) is None
    assert route(ROUND).move((0, 0), but((0, 1), BLOCKED)) is None


def test_what_lies_behind_or_is_unknown_cuts_nothing() -> None:
    """Only cells ahead that are known to be blocked cut."""
    way = route(ROUND)
    way.move((0, 0), OPEN)
    assert way.move((0, 1), but((0, 0), BLOCKED)) is Move.RIGHT
    assert way.move((0, 1), but((1, 1), UNKNOWN)) is Move.RIGHT


@pytest.mark.parametrize("cells", [[], [4]])
def test_a_route_of_no_steps_has_no_move(cells: list[int]) -> None:
    """An empty route and one of a single cell are at their end."""
    assert route(cells).move((1, 1), OPEN) is None
