"""What a scenario says of rings, beside their stations."""

from typing import ClassVar

import numpy as np

from fogbench import (
    BLOCKED,
    FREE,
    Array,
    BudgetSettings,
    Cell,
    Conditions,
    Layout,
    Probability,
    Settings,
    Task,
    Tasks,
)
from ring_kind.world import RingWorld


class Track(Settings):
    """The block that only rings have."""

    slip: Probability = 0.0
    """Probability that a step leads nowhere."""


class RingConditions(Conditions):
    """The conditions of a ring."""

    covariates: ClassVar[tuple[str, ...]] = ("stations",)

    track: Track = Track()
    tasks: Tasks = Tasks()
    budget: BudgetSettings

    def ring(self, links: Array, start: int, goal: int) -> RingWorld | None:
        """The world of a task on a ring of links [N], or None where it does not fit."""
        links.setflags(write=False)
        straight = min((goal - start) % len(links), (start - goal) % len(links))
        task = Task("ring", goal, None, self.budget.over(straight), (len(links),))
        world = RingWorld(links, start, task, self.track.slip)
        least, most = self.tasks.bounds(task.budget)
        return world if start != goal and least <= world.shortest() <= most else None

    def world(self, layout: Layout, start: Cell, goal: Cell) -> RingWorld | None:
        """The same on a map of cells: a station for each cell, row by row, with cut links at blocked cells."""
        blocked = layout.blocked.ravel()
        width = layout.blocked.shape[1]
        links = np.where(blocked | np.roll(blocked, -1), BLOCKED, FREE).astype(np.uint8)
        return self.ring(links, start[0] * width + start[1], goal[0] * width + goal[1])

    def shows(self, blocked: Array, cell: Cell, places: Array) -> Array:
        """Nothing is in view but the cell itself."""
        del blocked
        return np.asarray((places == cell).all(1))

    def wanted(self) -> str:
        """In words for an error."""
        return self.tasks.wanted("links")
