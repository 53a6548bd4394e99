"""The guide of D* Lite: the paths of A*, by repairing the last search."""

import numpy as np

from fogbench.planners.incremental import EMPTY
from fogbench.planners.robot.agent import plan
from fogbench.planners.robot.incremental import descent, replan
from fogbench.planners.robot.prices import prices_of
from fogbench.worlds.robot.driving import Pose
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.robot.octile import FAR
from fogbench.worlds.robot.rules import shape_of
from fogbench.worlds.robot.ways import cell_at
from fogbench.worlds.types import Array, Task


class DStarLiteGuide:
    """Repairs one search from the goal; where start or goal lie too close to a wall for it, A* finds the way."""

    def __init__(self, task: Task) -> None:
        """Plan towards the task's goal."""
        self.task = task
        extent, self.goal = shape_of(task), cell_at(task.goal, task.sensor.cell)
        self.g: Array = np.full(extent, FAR, np.int32)  # [H, W]
        self.rhs: Array = np.full(extent, FAR, np.int32)  # [H, W]
        self.queue: Array = np.zeros((EMPTY, 4), np.int32)  # U, [capacity, 4]
        self.at: Array = np.zeros(extent, np.int32)  # [H, W]
        self.last, self.k_m = self.goal, 0
        self.fresh = True
        self.nodes = 0

    def path(self, known: RobotMap, place: Pose, touched: Array) -> Array:
        """A cheapest path on the known map."""
        if self.fresh:  # the goal opens the search
            touched = np.append(touched, self.goal[0] * self.g.shape[1] + self.goal[1])
            self.fresh = False
        start, prices = cell_at(place, known.outfit.cell), prices_of(known.outfit)
        self.queue, self.last, self.k_m, expanded = replan(
            known.gap, prices, self.g, self.rhs, self.queue, self.at, self.goal, touched, start, self.last, self.k_m
        )
        path = descent(known.gap, prices, self.g, start, self.goal)
        if not len(path):
            path, more = plan(known, place, self.task.goal, optimist=True)
            expanded += more
        self.nodes += expanded
        return path

    def arrays(self) -> tuple[Array, ...]:
        """The costs and the queue."""
        return self.g, self.rhs, self.queue, self.at
