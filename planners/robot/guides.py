"""Paths that are followed until something cuts them, and the guide of A*."""

import numpy as np

from fogbench.planners.robot.agent import plan, zone_of
from fogbench.planners.robot.prices import prices_of
from fogbench.planners.robot.search import cut, nearest
from fogbench.worlds.robot.driving import Pose
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.robot.ways import cell_at
from fogbench.worlds.types import Array, Task

ASTRAY = 0.6
"""Metres from its path at which a robot looks for another one."""

WINDOW = 60
"""Cells of a path among which the robot is looked for."""


class Course:
    """A path that a robot follows until it is cut."""

    def __init__(self, task: Task) -> None:
        """None yet."""
        self.goal = cell_at(task.goal, task.sensor.cell)
        self.cells: Array = np.empty(0, np.int32)  # flat indices
        self.at = 0

    def follow(self, path: Array) -> None:
        """Take a new path, from its first cell on."""
        self.cells, self.at = path, 0

    def rest(self, known: RobotMap, place: Pose) -> Array:
        """What is left of the path from here; empty where it is cut, left or at its end."""
        outfit = known.outfit
        if self.at + 1 >= len(self.cells):
            return self.cells[:0]
        x, y, width = place[0] / outfit.cell, place[1] / outfit.cell, known.cells.shape[1]
        self.at, far = nearest(self.cells, self.at, x, y, width, WINDOW)
        if far * outfit.cell > ASTRAY:
            return self.cells[:0]
        if cut(known.gap, prices_of(outfit), zone_of(outfit), self.cells, self.at, self.goal):
            return self.cells[:0]
        return self.cells[self.at :]


class AStarGuide:
    """Plans on the known map, unknown counts as free or (no optimist) to its edge; keeps its path until it is cut."""

    def __init__(self, task: Task, *, eager: bool, optimist: bool = True) -> None:
        """Plan towards the task's goal; `eager` plans at every change."""
        self.goal, self.eager, self.optimist = task.goal, eager, optimist
        self.course = Course(task)
        self.nodes = 0

    def path(self, known: RobotMap, place: Pose, touched: Array) -> Array:
        """The rest of the path, or a new one."""
        rest = self.course.rest(known, place)
        if not len(rest) or (self.eager and len(touched)):
            path, expanded = plan(known, place, self.goal, optimist=self.optimist)
            self.nodes += expanded
            self.course.follow(path)
            rest = path
        return rest

    def arrays(self) -> tuple[Array, ...]:
        """The path."""
        return (self.course.cells,)
