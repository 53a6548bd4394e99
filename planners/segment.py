"""Straight motions in the plane over a grid: the cells that one touches, told exactly.

Words used here
    point   (row, column) in the plane, in cells; a cell is the closed unit square around its own row and column
    part    a cell is cut into PARTS by PARTS equal squares; a point stands for the middle of the part that it lies in

Middles are whole numbers of half parts, so no rounding decides what a motion touches. PARTS is odd: the centre of a
cell is a middle, and no middle lies on a border of cells. A motion leaves a cell through a side or exactly at a corner.
"""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import BLOCKED, Array

PARTS = 2**16 + 1
"""Parts along the side of a cell; the products below stay inside 64 bits on maps of up to 2**14 cells a side."""


@kernel
def walk(known: Array, row: float, column: float, end_row: float, end_column: float) -> Array:
    """The cells that a motion crosses, in order, each a neighbour of the one before.

    A motion through a corner touches both cells beside it; the one in the next row is part of the walk.

    Args:
        known: [H, W] uint8 of UNKNOWN, FREE, BLOCKED.
        row: of the first point, which lies half a part or more inside the map.
        column: of the first point.
        end_row: of the last point, likewise inside.
        end_column: of the last point.

    Returns:
        [n] int32, flat indices (row * W + column), one more than the Manhattan distance of the first cell and the last;
        empty if the motion touches a cell that is known to be blocked.
    """
    width = known.shape[1]
    u, v = int((row + 0.5) * PARTS), int((column + 0.5) * PARTS)
    end_u, end_v = int((end_row + 0.5) * PARTS), int((end_column + 0.5) * PARTS)
    rows, columns = abs(end_u - u), abs(end_v - v)  # [parts]
    r, c = u // PARTS, v // PARTS
    down, right = 1 if end_u > u else -1, 1 if end_v > v else -1
    to_row = abs(2 * PARTS * (r + (down > 0)) - 2 * u - 1)  # from the first point to the next row [half parts]
    to_column = abs(2 * PARTS * (c + (right > 0)) - 2 * v - 1)
    cells = np.empty(1 + abs(end_u // PARTS - r) + abs(end_v // PARTS - c), np.int32)
    if known[r, c] == BLOCKED:
        return cells[:0]
    cells[0] = r * width + c
    for k in range(1, len(cells)):
        next_row, next_column = to_row * columns, to_column * rows  # when each is reached, on one scale
        if next_row == next_column and known[r, c + right] == BLOCKED:
            return cells[:0]
        if next_row <= next_column:
            r += down
            to_row += 2 * PARTS
        else:
            c += right
            to_column += 2 * PARTS
        if known[r, c] == BLOCKED:
            return cells[:0]
        cells[k] = r * width + c
    return cells


@kernel
def clear(known: Array, row: float, column: float, end_row: float, end_column: float) -> bool:
    """Whether a motion touches no cell that is known to be blocked; the arguments are those of `walk`."""
    return len(walk(known, row, column, end_row, end_column)) > 0
