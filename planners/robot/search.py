"""A* over the eight neighbours of cells, each at its price (Hart, Nilsson & Raphael 1968)."""

import heapq

import numpy as np

from fogbench.planners.robot.prices import OPEN, price_of
from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.octile import CELLS, FAR, STEPS, octile
from fogbench.worlds.types import FREE, UNKNOWN, Array, Cell

EAGER = 1005
"""Thousandths of the estimate: a little more than it, so that of equals those nearer to the goal come first."""


@kernel
def search(
    cells: Array, gap: Array, prices: Array, zone: int, start: Cell, goal: Cell, optimist: bool
) -> tuple[Array, int]:
    """The cheapest path from start to goal, within half a percent.

    An optimist crosses unknown cells. Who is none crosses known free cells alone, and ends at the first of them beside
    an unknown one, from which the goal would be nearest if all that is unknown were free; or at the goal.

    Args:
        cells: [H, W] uint8 of UNKNOWN, FREE, BLOCKED.
        gap: [H, W] uint16.
        prices: [n] int32, see `prices`.
        zone: cells around both ends, see `price_of`.
        start: a cell.
        goal: a cell.
        optimist: which of the two it is.

    Returns:
        [n] int32, flat indices of the path with both ends, empty if there is none; and the number of expanded cells.
    """
    height, width = gap.shape
    g = np.full((height, width), FAR, np.int32)
    parent = np.full((height, width), -1, np.int32)
    closed = np.zeros((height, width), np.bool_)
    g[start] = 0
    queue = [start[0] * width + start[1]]
    expanded = 0
    while queue:
        flat = heapq.heappop(queue) % CELLS
        row, column = flat // width, flat % width
        if closed[row, column]:
            continue
        closed[row, column] = True
        expanded += 1
        if (row, column) == goal or (not optimist and _at_the_edge(cells, row, column)):
            return _path(parent, flat), expanded
        for down, right, cost in STEPS:
            r, c = row + down, column + right
            if not (0 <= r < height and 0 <= c < width) or closed[r, c] or not (optimist or cells[r, c] == FREE):
                continue
            price = price_of(gap, prices, (start, goal), zone, r, c)
            if price and g[row, column] + cost * price < g[r, c]:
                g[r, c] = g[row, column] + cost * price
                parent[r, c] = flat
                estimate = octile(goal[0] - r, goal[1] - c) * OPEN * EAGER // 1000
                heapq.heappush(queue, (g[r, c] + estimate) * CELLS + r * width + c)
    return np.empty(0, np.int32), expanded


@kernel
def _at_the_edge(cells: Array, row: int, column: int) -> bool:
    """Whether a neighbour is unknown."""
    for down, right, _ in STEPS:
        r, c = row + down, column + right
        if 0 <= r < cells.shape[0] and 0 <= c < cells.shape[1] and cells[r, c] == UNKNOWN:
            return True
    return False


@kernel
def _path(parent: Array, end: int) -> Array:
    count, flat = 0, end
    while flat >= 0:
        count, flat = count + 1, parent[flat // parent.shape[1], flat % parent.shape[1]]
    path, flat = np.empty(count, np.int32), end
    for k in range(count - 1, -1, -1):
        path[k], flat = flat, parent[flat // parent.shape[1], flat % parent.shape[1]]
    return path


@kernel
def cut(gap: Array, prices: Array, zone: int, path: Array, at: int, goal: Cell) -> bool:
    """Whether a path has a cell from its `at`th on where there is no room any more."""
    width = gap.shape[1]
    start = (path[at] // width, path[at] % width)
    for flat in path[at:]:  # noqa: SIM110  Numba has no any
        if price_of(gap, prices, (start, goal), zone, flat // width, flat % width) == 0:
            return True
    return False


@kernel
def nearest(path: Array, at: int, x: float, y: float, width: int, window: int) -> tuple[int, float]:
    """The place on a path that is nearest to a point, from its `at`th cell on; and how far it is, all in cells."""
    best, least = at, 1e30
    for k in range(at, min(len(path), at + window)):
        far = (path[k] // width + 0.5 - y) ** 2 + (path[k] % width + 0.5 - x) ** 2
        if far < least:
            best, least = k, far
    return best, np.sqrt(least)
