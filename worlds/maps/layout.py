"""From a map to a world: start and goal are drawn, connected, and inside the bounds."""

from abc import ABC, abstractmethod
from typing import ClassVar, NamedTuple

import numpy as np

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import manhattan
from fogbench.worlds.maps.distances import FAR, distances
from fogbench.worlds.settings import Positive, Settings
from fogbench.worlds.types import Array, Cell, MapError, Task

MAPS = 1000
"""Maps drawn before a family gives up."""

PAIRS = 100
"""Pairs of start and goal drawn on a map before another map is drawn."""


class Layout(NamedTuple):
    """A drawn map, with the task where the family fixes one."""

    blocked: Array
    """[H, W] bool."""
    start: Cell | None = None
    goal: Cell | None = None
    posts: frozenset[Cell] = frozenset()


class DrawnMaps(Settings, ABC):
    """A family that draws a fresh grid for every episode; a subclass says how."""

    kind: ClassVar[str] = "grid"

    @abstractmethod
    def draw(self, rng: np.random.Generator, conditions: GridConditions) -> Layout:
        """One map, with or without a task."""

    def sample(self, rng: np.random.Generator, episode: int, conditions: GridConditions) -> GridWorld:
        """The first drawn map on which a task fits the conditions; `episode` plays no part.

        Raises:
            MapError: none of MAPS maps had one.
        """
        del episode
        for _ in range(MAPS):
            found = fit(self.draw(rng, conditions), conditions, rng)
            if found is not None:
                return found
        raise MapError(f"{type(self).__name__}: no task with {wanted(conditions)} was found on {MAPS} maps")

    def tasks(self, conditions: GridConditions) -> int | None:
        """Any number."""
        del conditions
        return None

    def extent(self) -> Cell | None:
        """It differs."""
        return None


class SquareMaps(DrawnMaps):
    """A family of square maps of one size."""

    size: Positive
    """Side of the square map [cells]."""

    def extent(self) -> Cell:
        """As wide as high."""
        return self.size, self.size


def fit(layout: Layout, conditions: GridConditions, rng: np.random.Generator) -> GridWorld | None:
    """A world on a layout: with its own task, or with start and goal uniform over free cells; None if none fits."""
    if layout.start is not None and layout.goal is not None:
        return world(layout, layout.start, layout.goal, conditions)
    free = np.flatnonzero(~layout.blocked)  # [n]
    width = layout.blocked.shape[1]
    for _ in range(PAIRS if len(free) > 1 else 0):
        a, b = free[rng.integers(len(free), size=2)].tolist()
        found = world(layout, divmod(a, width), divmod(b, width), conditions)
        if found is not None:
            return found
    return None


def world(layout: Layout, start: Cell, goal: Cell, conditions: GridConditions) -> GridWorld | None:
    """The world of one task, or None where it is not connected or its optimum is out of bounds."""
    budget = conditions.budget.over(manhattan(start, goal))
    least, most = conditions.tasks.bounds(budget)
    if start == goal or manhattan(start, goal) > most or layout.blocked[start] or layout.blocked[goal]:
        return None
    layout.blocked.setflags(write=False)
    optimum = int(distances(layout.blocked, start, goal)[goal])
    if optimum == FAR or not least <= optimum <= most:
        return None
    height, width = layout.blocked.shape
    task = Task("grid", goal, conditions.sensor, budget, (height, width))
    return GridWorld(layout.blocked, start, task, conditions.rules, optimum, layout.posts)


def wanted(conditions: GridConditions) -> str:
    """The bounds of a task, in words for an error."""
    distance = conditions.tasks.distance
    return f"an optimum of {distance[0]} to {distance[1]} cells" if distance else "an optimum inside the step budget"
