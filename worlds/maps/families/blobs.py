"""Simple obstacles: rectangles strewn over an empty square (Khan et al. 2018, section 4.1)."""

from typing import Annotated

import numpy as np
from pydantic import AfterValidator, Field, ValidationInfo, field_validator

from fogbench.worlds.draws import below, luck
from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.layout import CellConditions, Layout, SquareMaps
from fogbench.worlds.settings import SIDE, PositiveRange, ascending
from fogbench.worlds.types import Array

Some = Annotated[int, Field(ge=0, le=1_000_000)]
"""Rectangles of one map."""


class Blobs(SquareMaps):
    """Rectangles of random size at random places, overlapping allowed, cut at the border."""

    size: Annotated[int, Field(ge=2, le=SIDE)]
    """Side of the square map [cells]."""
    obstacles: Annotated[tuple[Some, Some], AfterValidator(ascending)]
    """How many rectangles, drawn uniformly."""
    obstacle_size: PositiveRange
    """Both sides of each, drawn uniformly and apart [cells]."""

    @field_validator("obstacles")
    @classmethod
    def _no_more_than_cells(cls, obstacles: tuple[int, int], info: ValidationInfo) -> tuple[int, int]:
        cells = info.data.get("size", SIDE) ** 2
        if obstacles[1] > cells:
            raise ValueError(f"at most {cells:,} rectangles, one for each cell")
        return obstacles

    def draw(self, rng: np.random.Generator, conditions: CellConditions) -> Layout:
        """A map without a task; the upper left corner of a rectangle is uniform over the cells."""
        del conditions
        return Layout(strewn(luck(rng), self.size, *self.obstacles, *self.obstacle_size))


@kernel
def strewn(luck: int, size: int, fewest: int, most: int, smallest: int, largest: int) -> Array:
    """Which cells of a square lie in drawn rectangles: [size, size] bool; first all corners are drawn, then all sides.

    Args:
        luck: of the map, see `fogbench.worlds.draws`.
        size: of the square.
        fewest: rectangles, at least 0.
        most: rectangles.
        smallest: side of a rectangle, at least 1.
        largest: side of a rectangle.
    """
    count = fewest + below(luck, most - fewest + 1)
    corners, sides = np.empty((count, 2), np.int64), np.empty((count, 2), np.int64)
    for k in range(count):
        for axis in range(2):
            corners[k, axis] = below(luck, size)
    for k in range(count):
        for axis in range(2):
            sides[k, axis] = smallest + below(luck, largest - smallest + 1)
    return covered(size, corners, sides)


@kernel
def covered(size: int, corners: Array, sides: Array) -> Array:
    """Which cells of a square lie in a rectangle: [size, size] bool; each rectangle costs the same, however large.

    Args:
        size: of the square.
        corners: [count, 2] int64, the upper left ones.
        sides: [count, 2] int64, from 1; what lies outside of the square is cut.
    """
    depth = np.zeros((size + 1, size + 1), np.int32)  # at first, by how much that of each cell differs
    for k in range(len(corners)):
        top, left = corners[k]
        bottom, right = min(top + sides[k, 0], size), min(left + sides[k, 1], size)
        depth[top, left] += 1
        depth[top, right] -= 1
        depth[bottom, left] -= 1
        depth[bottom, right] += 1
    for r in range(size):
        for c in range(1, size):
            depth[r, c] += depth[r, c - 1]
        for c in range(size if r else 0):
            depth[r, c] += depth[r - 1, c]
    return depth[:size, :size] > 0
