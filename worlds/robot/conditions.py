"""Everything in a scenario that is neither maps nor agents, for worlds of kind `robot`."""

from math import atan2, hypot
from typing import ClassVar

import numpy as np
from pydantic import model_validator

from fogbench.worlds.conditions import BudgetSettings, Conditions
from fogbench.worlds.maps.covariates import COVARIATES
from fogbench.worlds.maps.layout import Layout
from fogbench.worlds.maps.sight import hidden
from fogbench.worlds.robot.rules import Body, Lidar, Outfit, RobotRules, RobotTasks, Walls
from fogbench.worlds.robot.walls import raised, touches
from fogbench.worlds.robot.world import RobotWorld, UnicycleWorld
from fogbench.worlds.types import Array, Cell, Task

FINEST = 100
"""Cells in the radius of a body at most."""


class RobotConditions(Conditions):
    """The conditions of a robot: walls, body, lidar, what a touch does, which tasks are drawn, what they may use up."""

    covariates: ClassVar[tuple[str, ...]] = COVARIATES

    walls: Walls = Walls()
    body: Body = Body()
    sensor: Lidar = Lidar()
    rules: RobotRules = RobotRules()
    tasks: RobotTasks = RobotTasks()
    budget: BudgetSettings

    @model_validator(mode="after")
    def _not_too_fine(self) -> "RobotConditions":
        if self.body.radius > FINEST * self.walls.side:
            raise ValueError(f"cells of at least {self.body.radius / FINEST:g} m for a body of {self.body.radius:g} m")
        return self

    def world(self, layout: Layout, start: Cell, goal: Cell) -> RobotWorld | None:
        """The world of one task between the middles of two cells, or None where it does not fit.

        It faces its goal. A tunnel's goal always counts.
        """
        cell, height = self.walls.cell, len(layout.blocked)
        begin, end = (((c + 0.5) * cell, (height - r - 0.5) * cell) for r, c in (start, goal))
        straight = hypot(end[0] - begin[0], end[1] - begin[1])
        budget = self.budget.over(straight)
        least, most = self._bounds(budget.steps)
        if straight <= self.tasks.goal_radius or straight > most or layout.blocked[start] or layout.blocked[goal]:
            return None
        cells = raised(layout.blocked, self.walls.split)
        side, around = self.walls.side, max(self.tasks.clearance, self.body.radius) / self.walls.side
        if any(touches(cells, x / side, y / side, around) for x, y in (begin, end)):
            return None
        outfit = Outfit(self.sensor, self.body, side, self.tasks.goal_radius)
        extent = cells.shape[1] * side, cells.shape[0] * side
        task = Task("robot", end, outfit, budget, extent)
        heading = atan2(end[1] - begin[1], end[0] - begin[0])
        cells.setflags(write=False)
        made = RobotWorld if self.rules.physics == "mujoco" else UnicycleWorld
        world = made(cells, (*begin, heading), task, self.rules)
        return world if least <= world.shortest() <= most else None

    def shows(self, blocked: Array, cell: Cell, places: Array) -> Array:
        """From which of the cells in `places` [n, 2] a beam can meet `cell` of a map [H, W]: [n] bool."""
        near: Array = np.hypot(*(places - cell).T) * self.walls.cell <= self.sensor.range
        for k in np.flatnonzero(near).tolist():
            row, column = places[k].tolist()
            near[k] = not hidden(blocked, row, column, cell[0] - row, cell[1] - column)
        return near

    def wanted(self) -> str:
        """Which tasks are drawn, in words for an error."""
        tasks = self.tasks
        bounds = "an optimum that full speed covers in the step budget (set by `budget: {steps: ...}`)"
        if tasks.distance is not None:
            bounds = (
                f"an optimum of {tasks.distance[0]:g} to {tasks.distance[1]:g} m (set by `tasks: {{distance: ...}}`)"
            )
        clear = f"{tasks.clearance:g} m of clearance at both ends (set by `tasks: {{clearance: ...}}`)"
        return f"{bounds}, {clear} and corridors wider than a body of {2 * self.body.radius:g} m"

    def _bounds(self, steps: int) -> tuple[float, float]:
        return self.tasks.distance or (1.0, steps * self.body.decision * self.body.speed)
