"""The words of the project, where their values are a promise."""

from itertools import pairwise

from fogbench.worlds.types import DELTAS, Move


def test_moves_come_in_quarter_turns() -> None:
    """Down, right, up, left: the next move is a quarter turn on, which is what a sideways slip counts on."""
    assert [move.name for move in Move] == ["DOWN", "RIGHT", "UP", "LEFT"]
    assert Move.DOWN.delta == (1, 0)
    for (row, column), after in pairwise((*DELTAS, DELTAS[0])):
        assert after == (-column, row)


def test_moves_know_their_deltas() -> None:
    """A move's delta is the entry of the table at its number."""
    assert [move.delta for move in Move] == list(DELTAS)
