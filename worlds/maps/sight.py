"""What is in view from a cell of a map, with occlusion and false readings.

Words used here
    blocked  [H, W] bool, the true map; everything outside it is blocked
    view     [K, K] uint8, the sensor's reading around the agent, whose own cell is in the middle
"""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.cells import passable
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array


@kernel
def look(blocked: Array, row: int, column: int, radius: int, occlusion: bool) -> Array:
    """The true view from a cell.

    With `occlusion`, a cell shows UNKNOWN where a blocked cell lies across the straight line between the two centres.

    Returns:
        [K, K] uint8, `K = 2 * radius + 1`.
    """
    height, width = blocked.shape
    side = 2 * radius + 1
    view = np.full((side, side), BLOCKED, np.uint8)  # [K, K]
    top, left = row - radius, column - radius
    for r in range(max(0, -top), min(side, height - top)):
        for c in range(max(0, -left), min(side, width - left)):
            if not blocked[top + r, left + c]:
                view[r, c] = FREE
    if occlusion:
        for r in range(side):
            for c in range(side):
                if hidden(blocked, row, column, r - radius, c - radius):
                    view[r, c] = UNKNOWN
    return view


@kernel
def hidden(blocked: Array, row: int, column: int, down: int, right: int) -> bool:
    """Whether a blocked cell lies across the straight line between the centres of two cells.

    The line is walked cell by cell. Where it runs exactly through a corner it is cut only if both cells beside that
    corner are blocked. The two cells at its ends do not cut it.
    """
    rows, columns = abs(down), abs(right)
    r, c, i, j = row, column, 0, 0  # the cell, and how many rows and columns it is away
    while i + j < rows + columns:
        side = (2 * i + 1) * columns - (2 * j + 1) * rows  # < 0: the line leaves the cell through a row's edge
        down_cell = (r + 1 if down > 0 else r - 1, c)
        right_cell = (r, c + 1 if right > 0 else c - 1)
        if side == 0:
            if not passable(blocked, *down_cell) and not passable(blocked, *right_cell):
                return True
            r, c, i, j = down_cell[0], right_cell[1], i + 1, j + 1
        elif side < 0:
            r, i = down_cell[0], i + 1
        else:
            c, j = right_cell[1], j + 1
        if i + j < rows + columns and not passable(blocked, r, c):
            return True
    return False


def misread(view: Array, wrong: Array) -> Array:
    """The view with free and blocked exchanged where `wrong` [K, K] bool says so; UNKNOWN stays."""
    return np.where(wrong & (view != UNKNOWN), FREE + BLOCKED - view, view).astype(np.uint8)  # [K, K]
