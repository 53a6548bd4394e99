"""Where moves lead, and slips: what a single grid world and a batch of them go by."""

import numpy as np

from fogbench.worlds.grid.rules import GridRules
from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.cells import passable
from fogbench.worlds.types import DELTAS, Array, Move


@kernel
def go(blocked: Array, row: int, column: int, move: int) -> tuple[int, int, bool]:
    """The cell that a move leads to, and whether an obstacle stopped it."""
    down, right = DELTAS[move]
    if passable(blocked, row + down, column + right):
        return row + down, column + right, False
    return row, column, True


def slip(rules: GridRules, move: Move, rng: np.random.Generator) -> tuple[Move | None, bool]:
    """What becomes of a move, None if it leads nowhere, and whether that is a slip."""
    if not rules.slip:
        return move, False
    slips, side = rng.random(2)  # always two numbers, so that the stream never shifts
    if slips >= rules.slip:
        return move, False
    if rules.slip_to == "stay":
        return None, True
    return Move((move + (1 if side < 0.5 else 3)) % 4), True
