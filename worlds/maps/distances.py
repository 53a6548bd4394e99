"""Shortest 4-connected distances on a grid, by breadth-first search."""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import DELTAS, Array, Cell

FAR = np.iinfo(np.int32).max
"""The distance of a cell that was not reached."""


@kernel
def distances(blocked: Array, source: Cell, target: Cell) -> Array:
    """Distances in cells from `source`, settled up to and including the distance of `target`.

    Args:
        blocked: [H, W] bool.
        source: where the search begins; its own value in `blocked` does not matter.
        target: the search stops when it is reached; `(-1, -1)` searches everything.

    Returns:
        [H, W] int32; FAR where no path was found before the search stopped.
    """
    height, width = blocked.shape
    distance = np.full((height, width), FAR, np.int32)
    queue = np.empty(height * width, np.int32)
    distance[source] = 0
    queue[0] = source[0] * width + source[1]
    head, tail = 0, 1
    while head < tail:
        r, c = queue[head] // width, queue[head] % width
        head += 1
        if r == target[0] and c == target[1]:
            break
        for down, right in DELTAS:
            i, j = r + down, c + right
            if 0 <= i < height and 0 <= j < width and distance[i, j] == FAR and not blocked[i, j]:
                distance[i, j] = distance[r, c] + 1
                queue[tail] = i * width + j
                tail += 1
    return distance


@kernel
def nearer(distance: Array, place: Cell) -> Array:
    """Which of the four neighbours of `place` are nearer by `distance` [H, W], as `distances` tells it: [4] bool."""
    found = np.zeros(4, np.bool_)
    if distance[place] == FAR:
        return found
    for move in range(4):
        r, c = place[0] + DELTAS[move][0], place[1] + DELTAS[move][1]
        inside = 0 <= r < distance.shape[0] and 0 <= c < distance.shape[1]
        found[move] = inside and distance[r, c] == distance[place] - 1  # a blocked cell is FAR
    return found
