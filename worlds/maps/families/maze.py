"""Perfect mazes, and mazes with loops (Randomized Kruskal: a spanning tree over random weights)."""

from typing import Annotated

import numpy as np
from pydantic import AfterValidator, Field
from scipy.sparse import coo_array
from scipy.sparse.csgraph import minimum_spanning_tree

from fogbench.worlds.maps.layout import CellConditions, Layout, SquareMaps
from fogbench.worlds.settings import SIDE, Probability


def _odd(size: int) -> int:
    if size % 2 == 0:
        raise ValueError("an odd number")
    return size


class Maze(SquareMaps):
    """Corridors one cell wide: the cells on even rows and columns, joined by a random spanning tree.

    There is no wall around the maze: everything outside a map is blocked.
    """

    size: Annotated[int, Field(ge=3, le=SIDE), AfterValidator(_odd)]
    """Side of the square map [cells], odd."""
    loops: Probability = 0.0
    """Probability of a wall between two neighbouring corridor cells, which the tree has left standing, to be opened."""

    def draw(self, rng: np.random.Generator, conditions: CellConditions) -> Layout:
        """A maze without a task."""
        del conditions
        side = (self.size + 1) // 2
        cells = np.arange(side * side).reshape(side, side)
        a = np.concatenate([cells[:, :-1].ravel(), cells[:-1].ravel()])  # [walls]
        b = np.concatenate([cells[:, 1:].ravel(), cells[1:].ravel()])  # [walls]
        weights = 1 - rng.random(len(a))  # above 0, which would read as no edge
        tree = minimum_spanning_tree(coo_array((weights, (a, b)), shape=(side**2, side**2))).tocoo()
        extra = rng.random(len(a)) < self.loops

        blocked = np.ones((self.size, self.size), np.bool_)  # [H, W]
        blocked[::2, ::2] = False
        _open(blocked, tree.row, tree.col, side)
        _open(blocked, a[extra], b[extra], side)
        return Layout(blocked)


def _open(blocked: np.ndarray, a: np.ndarray, b: np.ndarray, side: int) -> None:
    """Clear the wall between each pair of neighbouring cells; it lies halfway, at the sum of their indices."""
    blocked[a // side + b // side, a % side + b % side] = False
