"""Cells of a map, and remembering them: the one implementation that episodes, planners, judges and training share.

Words used here
    blocked  [H, W] bool, the true map; everything outside it is blocked
    known    [H, W] uint8 of UNKNOWN, FREE, BLOCKED, the map seen so far
    view     [K, K] uint8, the sensor's reading around the agent, whose own cell is in the middle
    touched  [n] int32, flat indices (row * W + column) of the cells whose reading a view has changed
"""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import FREE, UNKNOWN, Array, Cell, Observation


def manhattan(a: Cell, b: Cell) -> int:
    """Length of the shortest path between two cells of an empty map [cells]."""
    return abs(a[0] - b[0]) + abs(a[1] - b[1])


@kernel
def passable(blocked: Array, row: int, column: int) -> bool:
    """Whether a cell lies on the map and is free."""
    return 0 <= row < blocked.shape[0] and 0 <= column < blocked.shape[1] and not blocked[row, column]


@kernel
def fuse(known: Array, view: Array, row: int, column: int) -> Array:
    """Write a view into the known map: the latest reading wins, UNKNOWN tells nothing, the own cell is free.

    Returns:
        `touched`, in rows from the top.
    """
    height, width = known.shape
    side = view.shape[0]
    top, left = row - side // 2, column - side // 2
    touched = np.empty(side * side, np.int32)
    count = 0
    for r in range(max(0, -top), min(side, height - top)):
        for c in range(max(0, -left), min(side, width - left)):
            reading = view[r, c]
            if r == side // 2 and c == side // 2:
                reading = FREE
            if reading != UNKNOWN and reading != known[top + r, left + c]:
                known[top + r, left + c] = reading
                touched[count] = (top + r) * width + left + c
                count += 1
    return touched[:count].copy()


def enlarged(maps: Array, extent: tuple[int, int], beyond: int) -> Array:
    """Maps [B, H, W] on which another of `extent` has room; what is new is `beyond`."""
    height, width = max(maps.shape[1], extent[0]), max(maps.shape[2], extent[1])
    if (height, width) == maps.shape[1:]:
        return maps
    larger = np.full((len(maps), height, width), beyond, maps.dtype)
    larger[:, : maps.shape[1], : maps.shape[2]] = maps
    return larger


class KnownMap:
    """The map as far as one agent has seen it."""

    def __init__(self, extent: tuple[float, ...]) -> None:
        """Nothing is known yet of a map of `extent` `(H, W)`."""
        self.cells: Array = np.zeros((int(extent[0]), int(extent[1])), np.uint8)  # [H, W], UNKNOWN

    def update(self, observation: Observation) -> Array:
        """Write the view of an observation into the map.

        Returns:
            [n] int32, flat indices of the cells whose reading has changed.
        """
        return fuse(self.cells, observation.view, *observation.place)
