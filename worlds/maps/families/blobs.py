"""Simple obstacles: rectangles strewn over an empty square (Khan et al. 2018, section 4.1)."""

from typing import Annotated

import numpy as np
from pydantic import AfterValidator, Field

from fogbench.worlds.maps.layout import CellConditions, Layout, SquareMaps
from fogbench.worlds.settings import SIDE, PositiveRange, ascending

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

    def draw(self, rng: np.random.Generator, conditions: CellConditions) -> Layout:
        """A map without a task; the upper left corner of a rectangle is uniform over the cells."""
        del conditions
        blocked = np.zeros((self.size, self.size), np.bool_)  # [H, W]
        count = int(rng.integers(*self.obstacles, endpoint=True))
        corners = rng.integers(self.size, size=(count, 2))  # [count, 2]
        sides = rng.integers(*self.obstacle_size, size=(count, 2), endpoint=True)  # [count, 2]
        for (r, c), (rows, columns) in zip(corners.tolist(), sides.tolist(), strict=True):
            blocked[r : r + rows, c : c + columns] = True
        return Layout(blocked)
