"""A path of cells that an agent follows, step by step, until something cuts it."""

import numpy as np

from worlds.kernel import kernel
from worlds.types import BLOCKED, DELTAS, Array, Cell, Move

MOVES = {delta: move for move, delta in zip(Move, DELTAS, strict=True)}


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
        here = place[0] * self.width + place[1]
        if self.at + 1 < len(self.cells) and self.cells[self.at + 1] == here:
            self.at += 1
        if self.at + 1 >= len(self.cells) or self.cells[self.at] != here or _cut(known, self.cells, self.at + 1):
            return None
        row, column = divmod(int(self.cells[self.at + 1]), self.width)
        return MOVES[row - place[0], column - place[1]]


@kernel
def _cut(known: Array, cells: Array, first: int) -> bool:
    flat = known.reshape(-1)  # [H * W]
    return bool(np.any(flat[cells[first:]] == BLOCKED))
