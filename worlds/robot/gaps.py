"""How much room there is around each cell: the inflation of a map, for any radius at once, kept up as it changes.

Words used here
    cells    [H, W] uint8 of UNKNOWN, FREE, BLOCKED, row 0 at the bottom; everything outside it is blocked
    gap      [H, W] uint16, from the middle of a cell to the nearest point of a blocked one, squared, in half cells
             (whole numbers, so that no rounding decides); one more than that of the last ring where it is larger.
             A disc around the middle is free of walls if its radius, squared, in half cells, is no larger than this
    rings    [n, 3] int64, offsets in rows and columns, and their gap, of all cells in reach, the nearest first
    touched  [n] int64, flat indices (row * W + column) of cells that have changed
"""

from functools import lru_cache

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import BLOCKED, Array


@lru_cache(maxsize=16)
def rings(reach: int) -> Array:
    """The offsets of all cells whose nearest point is at most `reach` [half cells] away."""
    side = np.arange(-reach, reach + 1)  # [n]
    far = np.maximum(2 * np.abs(side) - 1, 0) ** 2  # [n], of each row or column
    square = far[:, None] + far  # [n, n]
    at = np.argwhere(square <= reach**2)  # [m, 2]
    order = np.argsort(square[at[:, 0], at[:, 1]], kind="stable")
    found: Array = np.column_stack([side[at], square[at[:, 0], at[:, 1]]])[order]
    found.setflags(write=False)
    return found


@kernel
def border(row: int, column: int, height: int, width: int, beyond: int) -> int:
    """The gap to the border of the map, and `beyond` at most."""
    side = 2 * min(row, column, height - 1 - row, width - 1 - column) + 1
    return min(side * side, beyond)


@kernel
def gaps(cells: Array, rings: Array) -> Array:
    """The gap of all cells of a map."""
    height, width = cells.shape
    beyond = rings[-1, 2] + 1
    gap = np.empty((height, width), np.uint16)
    for row in range(height):
        for column in range(width):
            gap[row, column] = border(row, column, height, width, beyond)
    for row in range(height):
        for column in range(width):
            if cells[row, column] == BLOCKED:
                inner = 0 < row < height - 1 and 0 < column < width - 1
                if inner and (cells[row - 1 : row + 2, column - 1 : column + 2] == BLOCKED).all():
                    gap[row, column] = 0  # its neighbours are nearer to all others
                else:
                    _narrow(gap, rings, row, column)
    return gap


@kernel
def _narrow(gap: Array, rings: Array, row: int, column: int) -> None:
    """A cell is blocked."""
    for k in range(len(rings)):
        r, c = row + rings[k, 0], column + rings[k, 1]
        if 0 <= r < gap.shape[0] and 0 <= c < gap.shape[1] and rings[k, 2] < gap[r, c]:
            gap[r, c] = rings[k, 2]


@kernel
def keep_up(cells: Array, gap: Array, rings: Array, touched: Array) -> Array:
    """Bring the gaps up to date where readings have changed: cells that came to be blocked, and that are no longer.

    Returns:
        Flat indices of all cells whose gap has changed, in no order; one may be there more than once.
    """
    height, width = cells.shape
    changed = np.empty(len(rings) * len(touched), np.int64)
    count = 0
    for flat in touched:
        row, column = flat // width, flat % width
        freed = cells[row, column] != BLOCKED
        for k in range(len(rings)):
            r, c = row + rings[k, 0], column + rings[k, 1]
            if not (0 <= r < height and 0 <= c < width):
                continue
            if freed and rings[k, 2] == gap[r, c]:
                new = _nearest(cells, rings, r, c)
            elif not freed and rings[k, 2] < gap[r, c]:
                new = rings[k, 2]
            else:
                continue
            if new != gap[r, c]:
                gap[r, c] = new
                changed[count] = r * width + c
                count += 1
    return changed[:count].copy()


@kernel
def _nearest(cells: Array, rings: Array, row: int, column: int) -> int:
    """The gap of one cell, looked for from the nearest cell on."""
    height, width = cells.shape
    edge = border(row, column, height, width, rings[-1, 2] + 1)
    for k in range(len(rings)):
        if rings[k, 2] >= edge:
            break
        if cells[row + rings[k, 0], column + rings[k, 1]] == BLOCKED:
            return int(rings[k, 2])
    return edge
