"""Shortest 8-connected lengths on cells with room for a disc, from one cell to all.

A step to a side costs SIDE and one to a corner CORNER, so that lengths are whole numbers; their ratio is the square
root of two within 0.0001 from above. An octile path is at most 8.25 % longer than the shortest line of any angle.
"""

import heapq

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array, Cell

SIDE, CORNER = 70, 99
"""What a step costs; a cell is SIDE long."""

STEPS = ((1, 0, SIDE), (0, 1, SIDE), (-1, 0, SIDE), (0, -1, SIDE),
         (1, 1, CORNER), (-1, 1, CORNER), (-1, -1, CORNER), (1, -1, CORNER))  # fmt: skip
"""Rows, columns and cost of each of the eight steps, in the order that breaks ties."""

FAR = np.iinfo(np.int32).max
"""The length of a cell that was not reached."""

CELLS = 1 << 32
"""A queue holds length * CELLS + flat index, so that it compares one number."""


@kernel
def octile(rows: int, columns: int) -> int:
    """The length of a shortest path over so many rows and columns without any wall."""
    low, high = min(abs(rows), abs(columns)), max(abs(rows), abs(columns))
    return CORNER * low + SIDE * (high - low)


@kernel
def lengths(gap: Array, room: int, source: Cell) -> Array:
    """Lengths from `source` to all cells (Dijkstra 1959).

    Args:
        gap: [H, W] uint16, see `gaps`.
        room: the gap that a cell must have; the source needs none.
        source: a cell.

    Returns:
        [H, W] int32; FAR where no path leads.
    """
    height, width = gap.shape
    length = np.full((height, width), FAR, np.int32)
    length[source] = 0
    queue = [source[0] * width + source[1]]
    while queue:
        way, flat = divmod(heapq.heappop(queue), CELLS)
        row, column = flat // width, flat % width
        if way > length[row, column]:
            continue
        for down, right, cost in STEPS:
            r, c = row + down, column + right
            if 0 <= r < height and 0 <= c < width and gap[r, c] >= room and way + cost < length[r, c]:
                length[r, c] = way + cost
                heapq.heappush(queue, (way + cost) * CELLS + r * width + c)
    return length
