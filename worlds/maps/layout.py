"""From a map of cells to a world: start and goal are drawn, connected, and inside the bounds."""

from abc import ABC, abstractmethod
from typing import Annotated, ClassVar, NamedTuple, Protocol

import numpy as np
from pydantic import Field

from fogbench.worlds.draws import below, luck
from fogbench.worlds.kernel import kernel
from fogbench.worlds.settings import SIDE, Settings
from fogbench.worlds.types import Array, Cell, MapError, World

MAPS, CELLS = 1000, 2**26
"""Maps drawn before a family gives up, and cells in all of them."""

PAIRS = 100
"""Pairs of start and goal drawn on a map before another map is drawn."""


class Layout(NamedTuple):
    """A drawn map, with the task where the family fixes one."""

    blocked: Array
    """[H, W] bool."""
    start: Cell | None = None
    goal: Cell | None = None
    posts: frozenset[Cell] = frozenset()
    """Cells of which one must be visited before the goal counts; empty: it always counts."""


class CellConditions(Protocol):
    """**Protocol:** conditions of any kind whose worlds can be made from a map of cells; they are hashable."""

    def __hash__(self) -> int:
        """Equal conditions have equal ones."""

    def world(self, layout: Layout, start: Cell, goal: Cell) -> World | None:
        """The world of one task, or None where it does not fit these conditions."""

    def shows(self, blocked: Array, cell: Cell, places: Array) -> Array:
        """From which of the cells in `places` [n, 2] the sensor shows `cell` of a map [H, W]: [n] bool."""

    def wanted(self) -> str:
        """Which tasks fit, in words for an error."""


class CellMaps(Settings):
    """A family of maps of cells."""

    kinds: ClassVar[tuple[str, ...]] = ("grid",)

    def tasks(self, conditions: CellConditions, most: int) -> int | None:
        """Any number."""
        del conditions, most
        return None

    def extent(self) -> Cell | None:
        """It differs, or a file has to be read to know."""
        return None


class DrawnMaps(CellMaps, ABC):
    """A family that draws a fresh map for every episode; a subclass says how."""

    @abstractmethod
    def draw(self, rng: np.random.Generator, conditions: CellConditions) -> Layout:
        """One map, with or without a task."""

    def sample(self, rng: np.random.Generator, episode: int, conditions: CellConditions) -> World:
        """The first drawn map on which a task fits the conditions; `episode` plays no part.

        Raises:
            MapError: none of MAPS maps, or of CELLS cells, had one.
        """
        del episode
        maps = cells = 0
        while maps < MAPS and cells < CELLS:
            layout = self.draw(rng, conditions)
            found = fit(layout, conditions, rng)
            if found is not None:
                return found
            maps, cells = maps + 1, cells + layout.blocked.size
        raise MapError(f"{type(self).__name__}: no task with {conditions.wanted()} was found on {maps} maps")


class SquareMaps(DrawnMaps):
    """A family of square maps of one size."""

    size: Annotated[int, Field(ge=1, le=SIDE)]
    """Side of the square map [cells]."""

    def extent(self) -> Cell:
        """As wide as high."""
        return self.size, self.size


def fit(layout: Layout, conditions: CellConditions, rng: np.random.Generator) -> World | None:
    """A world on a layout: with its own task, or with start and goal uniform over free cells; None if none fits."""
    if layout.start is not None and layout.goal is not None:
        return conditions.world(layout, layout.start, layout.goal)
    free = np.flatnonzero(~layout.blocked)  # [n]
    width = layout.blocked.shape[1]
    for _ in range(PAIRS if len(free) > 1 else 0):
        a, b = two_of(free, luck(rng))
        found = conditions.world(layout, divmod(a, width), divmod(b, width))
        if found is not None:
            return found
    return None


@kernel
def two_of(cells: Array, luck: int) -> tuple[int, int]:
    """Two of [n] cells, each uniform, so that they may be one."""
    return cells[below(luck, len(cells))], cells[below(luck, len(cells))]
