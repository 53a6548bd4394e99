"""The bug trap: a U between the agent, which starts inside, and its goal behind the closed end."""

import numpy as np
from pydantic import model_validator

from fogbench.worlds.maps.layout import CellConditions, Layout, SquareMaps
from fogbench.worlds.settings import PositiveRange, Range
from fogbench.worlds.types import Cell

AROUND = 4
"""Two walls, and a free cell outside each."""


class BugTrap(SquareMaps):
    """A U of walls, one cell thick, somewhere in a free square, its mouth turned away from the goal.

    Lips narrow the mouth from both sides. The mouth faces any of the four directions.
    """

    depth: PositiveRange
    """Inner cells from the mouth to the closed end, drawn uniformly."""
    width: PositiveRange
    """Inner cells across, drawn uniformly."""
    lip: Range = (0, 0)
    """Length of both lips, drawn uniformly; they stand in front of the mouth [cells]."""

    @model_validator(mode="after")
    def _fits(self) -> "BugTrap":
        least = max(self.depth[1], self.width[1]) + AROUND
        if self.size < least:
            raise ValueError(f"a size from {least}, for depth {self.depth[1]} and width {self.width[1]}")
        if 2 * self.lip[1] >= self.width[0]:
            raise ValueError(f"a width from {2 * self.lip[1] + 1}, for lips of {self.lip[1]}")
        return self

    def draw(self, rng: np.random.Generator, conditions: CellConditions) -> Layout:
        """A trap with its task: start uniform inside, goal uniform behind the closed end, as wide as the trap."""
        del conditions
        depth, width, lip = (int(rng.integers(*bounds, endpoint=True)) for bounds in (self.depth, self.width, self.lip))
        top = int(rng.integers(2, self.size - depth - 1))  # the closed end is up
        left = int(rng.integers(2, self.size - width - 1))
        bottom, right = top + depth, left + width

        blocked = np.zeros((self.size, self.size), np.bool_)  # [H, W]
        blocked[top - 1 : bottom + 1, left - 1 : right + 1] = True
        blocked[top:bottom, left:right] = False
        blocked[bottom, left + lip : right - lip] = False
        if lip == 0:
            blocked[bottom] = False
        start = int(rng.integers(top, bottom)), int(rng.integers(left, right))
        goal = int(rng.integers(top - 1)), int(rng.integers(left, right))

        turns = int(rng.integers(4))
        blocked = np.ascontiguousarray(np.rot90(blocked, turns))
        return Layout(blocked, _turned(start, turns, self.size), _turned(goal, turns, self.size))


def _turned(cell: Cell, turns: int, size: int) -> Cell:
    """Where a cell lies after as many quarter turns of `numpy.rot90`."""
    for _ in range(turns):
        cell = size - 1 - cell[1], cell[0]
    return cell
