"""The moments of an episode in a tunnel at which a memory is said to change (Khan et al. 2018, appendix B.3)."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.ndimage import binary_opening

from fogbench.worlds.types import Array, Cell


def in_tunnel(blocked: Array, posts: frozenset[Cell], width: int, path: Sequence[Cell]) -> dict[str, int]:
    """The steps of the end wall first in view, of the turn and of the exit, by name; what did not happen is left out.

    Args:
        blocked: [H, W] bool, the map.
        posts: cells from which the end wall is seen.
        width: inner width of the corridor.
        path: the cell of each decision, and the last.

    Returns:
        The first decision that is taken with the end wall in view; that leads, inside of the corridor, back to a cell
        visited before; that is taken outside of the corridor.
    """
    inside = corridor(blocked, width)
    first = {place: step for step, place in reversed(list(enumerate(path)))}
    happened = {
        "end wall in view": [place in posts for place in path[:-1]],
        "turn": [bool(inside[place]) and first[after] < first[place] for place, after in pairwise(path)],
        "exit": [not inside[place] for place in path[:-1]],
    }
    return {name: steps.index(True) for name, steps in happened.items() if any(steps)}


def corridor(blocked: Array, width: int) -> Array:
    """The free cells [H, W] bool where no square of free cells fits that is one wider than a tunnel of some `width`.

    Beyond the map all counts as free: the margin around the walls is narrower than such a square. With bends, narrow
    pockets between the walls count as well.
    """
    reach = width + 1
    free = np.pad(~blocked, reach, constant_values=True)  # [H + 2 * reach, W + 2 * reach]
    narrow = free & ~binary_opening(free, np.ones((reach, reach), np.bool_))
    cells: Array = narrow[reach:-reach, reach:-reach]
    return cells
