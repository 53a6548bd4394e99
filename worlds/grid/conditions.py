"""Everything in a scenario that is neither maps nor agents, for worlds of kind `grid`."""

from typing import ClassVar

from fogbench.worlds.conditions import BudgetSettings, Conditions, Tasks
from fogbench.worlds.grid.rules import GridRules, SquareView
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import manhattan
from fogbench.worlds.maps.covariates import COVARIATES
from fogbench.worlds.maps.distances import FAR, distance
from fogbench.worlds.maps.layout import Layout
from fogbench.worlds.types import Array, Cell, Task


class GridConditions(Conditions):
    """The conditions of a grid: what is seen, what a move does, which tasks are drawn, what they may use up."""

    covariates: ClassVar[tuple[str, ...]] = COVARIATES

    sensor: SquareView = SquareView()
    rules: GridRules = GridRules()
    tasks: Tasks = Tasks()
    budget: BudgetSettings

    def world(self, layout: Layout, start: Cell, goal: Cell) -> GridWorld | None:
        """The world of one task on a map, or None where it is not connected or its optimum is out of bounds."""
        straight = manhattan(start, goal)
        budget = self.budget.over(straight)
        least, most = self.tasks.bounds(budget)
        if start == goal or straight > most or layout.blocked[start] or layout.blocked[goal]:
            return None
        layout.blocked.setflags(write=False)
        optimum = int(distance(layout.blocked, start, goal, most))
        if optimum == FAR or optimum < least:
            return None
        height, width = layout.blocked.shape
        task = Task("grid", goal, self.sensor, budget, (height, width))
        return GridWorld(layout.blocked, start, task, self.rules, optimum, layout.posts)

    def shows(self, blocked: Array, cell: Cell, places: Array) -> Array:
        """From which of the cells in `places` [n, 2] the sensor shows `cell` of a map [H, W]: [n] bool."""
        return self.sensor.shows(blocked, cell, places)

    def wanted(self) -> str:
        """Which tasks are drawn, in words for an error."""
        return self.tasks.wanted("cells")
