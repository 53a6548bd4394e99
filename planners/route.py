"""A path of cells that an agent follows, step by step, until something cuts it."""

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import BLOCKED, DELTAS, Array, Cell, Move

MOVES = tuple(Move)


class Route:
    """Cells to walk through, each a neighbour of the one before."""

    def __init__(self, cells: Array, width: int) -> None:
        """Follow `cells` [n] int32, flat indices (row * width + column) from the agent's cell on; may be empty."""
        self.cells = cells
        self.width = width
        self.at = 0

    def move(self, place: Cell, known: Array) -> Move | None:
        """The next move from `place`; None at the end, off the route, or with a known blocked cell ahead.

        Args:
            place: the agent's cell: where it was before the last move, or one cell on.
            known: [H, W] uint8, the known map.
        """
        self.at, move = _follow(self.cells, self.at, self.width, known, place)
        return None if move < 0 else MOVES[move]


@kernel
def _follow(cells: Array, at: int, width: int, known: Array, place: Cell) -> tuple[int, int]:
    """Where on the route `place` is, with `at` the last such answer, and the next move; -1 if there is none."""
    here = place[0] * width + place[1]
    if at + 1 < len(cells) and cells[at + 1] == here:
        at += 1
    if at + 1 >= len(cells) or cells[at] != here:
        return at, -1
    for cell in cells[at + 1 :]:
        if known[cell // width, cell % width] == BLOCKED:
            return at, -1
    for move in range(4):
        if cells[at + 1] - here == DELTAS[move][0] * width + DELTAS[move][1]:
            return at, move
    return at, -1
