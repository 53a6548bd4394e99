"""Shortest 4-connected distances on a grid: from one cell to all by breadth-first search, to one by A*."""

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
def distance(blocked: Array, source: Cell, target: Cell, most: int) -> int:
    """The distance between two cells, if it is `most` at most; FAR where it is not, or there is no path.

    A* with the Manhattan distance: as a step is 1 and changes that by 1, it leaves the estimate of a path through a
    cell, or adds 2. So two stacks do for a queue: cells of this estimate, and of the next.

    Args:
        blocked: [H, W] bool.
        source, target: two cells of it; their own values in `blocked` do not matter.
        most: at least 0; no path that must be longer is looked at.
    """
    height, width = blocked.shape
    seen = np.zeros((height, width), np.uint8)  # 1: waits in `later`; 2: came into `now`, and is settled
    now, later = np.empty(height * width, np.int32), np.empty(height * width, np.int32)
    now[0], waiting, coming = source[0] * width + source[1], 1, 0
    seen[source] = 2
    estimate = abs(source[0] - target[0]) + abs(source[1] - target[1])
    while estimate <= most:
        while waiting:
            waiting -= 1
            r, c = now[waiting] // width, now[waiting] % width
            if r == target[0] and c == target[1]:
                return estimate
            for down, right in DELTAS:
                i, j = r + down, c + right
                if not (0 <= i < height and 0 <= j < width) or seen[i, j] == 2:
                    continue
                if blocked[i, j] and not (i == target[0] and j == target[1]):
                    continue
                if abs(i - target[0]) + abs(j - target[1]) < abs(r - target[0]) + abs(c - target[1]):
                    seen[i, j] = 2
                    now[waiting] = i * width + j
                    waiting += 1
                elif seen[i, j] == 0:
                    seen[i, j] = 1
                    later[coming] = i * width + j
                    coming += 1
        for k in range(coming):
            if seen[later[k] // width, later[k] % width] == 1:
                seen[later[k] // width, later[k] % width] = 2
                now[waiting] = later[k]
                waiting += 1
        if waiting == 0:
            return FAR
        coming, estimate = 0, estimate + 2
    return FAR


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
