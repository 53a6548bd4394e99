"""From cells to walls: which rectangles they make, and what a disc touches.

Words used here
    cells    [H, W] uint8 of UNKNOWN, FREE, BLOCKED, row 0 at the bottom; everything outside it is blocked
"""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import BLOCKED, FREE, Array


def raised(blocked: Array, split: int) -> Array:
    """The cells of a robot's map, of a map [h, w] bool of a family, whose row 0 is at the top: flipped, and split."""
    cells = np.where(blocked[::-1], BLOCKED, FREE).astype(np.uint8)
    return np.repeat(np.repeat(cells, split, 0), split, 1)


@kernel
def rectangles(cells: Array) -> Array:
    """Rectangles that cover all blocked cells and nothing else, each cell once: [n, 4] row, column, rows, columns.

    Row by row, the next cell that is not covered is grown to the right as far as it goes, then upwards.
    """
    height, width = cells.shape
    left = cells == BLOCKED
    found = np.empty((left.sum(), 4), np.int64)
    count = 0
    for row in range(height):
        for column in range(width):
            if not left[row, column]:
                continue
            end = column
            while end < width and left[row, end]:
                end += 1
            top = row + 1
            while top < height and left[top, column:end].all():
                top += 1
            left[row:top, column:end] = False
            found[count] = row, column, top - row, end - column
            count += 1
    return found[:count].copy()


@kernel
def clearance(cells: Array, x: float, y: float, most: float) -> float:
    """The way from a point to the nearest blocked cell or the border, and `most` at most; all lengths in cells."""
    height, width = cells.shape
    nearest: float = min(x, y, width - x, height - y, most)
    for row in range(max(0, int(y - most)), min(height, int(y + most) + 1)):
        for column in range(max(0, int(x - most)), min(width, int(x + most) + 1)):
            if cells[row, column] == BLOCKED:
                across = max(column - x, 0.0, x - column - 1)
                along = max(row - y, 0.0, y - row - 1)
                nearest = min(nearest, np.sqrt(across * across + along * along))
    return nearest


@kernel
def touches(cells: Array, x: float, y: float, radius: float) -> bool:
    """Whether a disc touches a blocked cell, or the border; all lengths in cells."""
    return clearance(cells, x, y, radius) < radius
