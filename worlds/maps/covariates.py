"""How difficult a grid map and its task are, in four numbers that need no planner."""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

COVARIATES = ("density", "detour", "dead_ends", "openness")
"""What `covariates` tells."""


def covariates(blocked: Array, straight: float, optimum: float) -> dict[str, float]:
    """The difficulty of a map [H, W] and of a task on it.

    Returns:
        `density`     share of blocked cells
        `detour`      optimum over straight distance, at least 1
        `dead_ends`   free cells with exactly one free neighbour of four, per 100 free cells
        `openness`    mean share of free cells among the eight neighbours of a free cell
    """
    density, dead_ends, openness = _survey(blocked)
    return dict(zip(COVARIATES, (density, optimum / straight, dead_ends, openness), strict=True))


@kernel
def _survey(blocked: Array) -> tuple[float, float, float]:
    height, width = blocked.shape
    free, ends, around = 0, 0, 0
    for r in range(height):
        for c in range(width):
            if blocked[r, c]:
                continue
            free += 1
            exits = 0
            for i in range(max(0, r - 1), min(height, r + 2)):
                for j in range(max(0, c - 1), min(width, c + 2)):
                    if not blocked[i, j] and (i, j) != (r, c):
                        around += 1
                        exits += i == r or j == c
            ends += exits == 1
    cells = max(free, 1)
    return 1 - free / np.float64(blocked.size), 100 * ends / cells, around / (8 * cells)
