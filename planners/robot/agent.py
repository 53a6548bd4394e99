"""A robot that plans: a known map, a guide that knows a path on it, and a pilot that drives along that path."""

from typing import Protocol

import numpy as np

from fogbench.planners.robot.pilot import Pilot
from fogbench.planners.robot.prices import ZONE, prices_of
from fogbench.planners.robot.search import search
from fogbench.worlds.robot.driving import Pose
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.robot.rules import Outfit
from fogbench.worlds.robot.ways import cell_at
from fogbench.worlds.types import Array, Observation, Task, Waypoint


class Guide(Protocol):
    """**Protocol:** knows a path on a known map."""

    nodes: int
    """Search effort so far."""

    def path(self, known: RobotMap, place: Pose, touched: Array) -> Array:
        """The cells from here to the goal: [n] int32, flat indices; empty where there is no path.

        Args:
            known: the map.
            place: of the robot.
            touched: [n] int64, flat indices of cells whose gap has changed since it was asked last.
        """

    def arrays(self) -> tuple[Array, ...]:
        """All that it carries to the next decision."""


class RobotAgent:
    """One episode of a robot that plans."""

    def __init__(self, task: Task, guide: Guide) -> None:
        """Nothing is known yet."""
        self.task, self.guide = task, guide
        self.known = RobotMap(task)
        self.pilot = Pilot(task.sensor)

    def act(self, observation: Observation) -> Waypoint | None:
        """The next waypoint; where the known map leaves no path, of one on the current view alone."""
        touched = self.known.update(observation)
        path = self.guide.path(self.known, observation.place, touched)
        if not len(path):
            path = glance(self.task, self.guide, observation)
        if not len(path):
            return None
        return self.pilot.waypoint(self.known.cells, observation.place, points(self.task, path))

    def memory_bytes(self) -> int:
        """The known map, its gaps, and what the guide carries."""
        return sum(array.nbytes for array in (self.known.cells, self.known.gap, *self.guide.arrays()))

    def search_nodes(self) -> int:
        """Cells expanded, or vertices added, so far."""
        return self.guide.nodes


def points(task: Task, path: Array) -> Array:
    """[n, 2] float64, the middles of cells [m]; in the cell of the goal, the goal itself."""
    cell = task.sensor.cell
    width = round(task.extent[0] / cell)
    middles: Array = np.stack([path % width + 0.5, path // width + 0.5], -1) * cell
    if len(path) and cell_at(task.goal, cell) == divmod(int(path[-1]), width):
        middles[-1] = task.goal
    return middles


def glance(task: Task, guide: Guide, observation: Observation) -> Array:
    """A path on the current view alone, everything else unknown."""
    known = RobotMap(task)
    known.update(observation)
    path, expanded = plan(known, observation.place, task.goal, optimist=True)
    guide.nodes += expanded
    return path


def plan(known: RobotMap, place: Pose, goal: tuple[float, float], *, optimist: bool) -> tuple[Array, int]:
    """A path of A*, and the cells expanded; see `search`."""
    outfit: Outfit = known.outfit
    start, end = cell_at(place, outfit.cell), cell_at(goal, outfit.cell)
    return search(known.cells, known.gap, prices_of(outfit), zone_of(outfit), start, end, optimist)


def zone_of(outfit: Outfit) -> int:
    """The zone around start and goal [cells]."""
    return round(ZONE / outfit.cell)
