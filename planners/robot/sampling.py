"""The guide of RRT* and its like: a path of OMPL in the plane or in SE(2), followed until it is cut."""

from itertools import pairwise
from typing import Any

import numpy as np
from ompl import base

from fogbench.planners.robot.agent import zone_of
from fogbench.planners.robot.guides import Course
from fogbench.planners.robot.prices import price_of, prices_of
from fogbench.planners.sampling import SEEDS, solved
from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.driving import Pose
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.robot.ways import cell_at
from fogbench.worlds.types import Array, Cell, Task

EDGE = 1e-3
"""Cells between the border and any state."""


class RrtStarGuide:
    """Plans when its path is cut; a plan that does not end at the goal counts for none."""

    def __init__(self, task: Task, planner: str, iterations: int, space: str, rng: np.random.Generator) -> None:
        """Plan towards the task's goal; every plan draws its seed."""
        self.task, self.planner, self.iterations, self.space, self.rng = task, planner, iterations, space, rng
        self.course = Course(task)
        self.nodes = 0

    def path(self, known: RobotMap, place: Pose, touched: Array) -> Array:
        """The rest of the path, or a new one."""
        del touched
        rest = self.course.rest(known, place)
        if not len(rest):
            rest = self._planned(known, place)
            self.course.follow(rest)
        return rest

    def arrays(self) -> tuple[Array, ...]:
        """The path; trees do not outlive their plan."""
        return (self.course.cells,)

    def _planned(self, known: RobotMap, place: Pose) -> Array:
        seed, cell = int(self.rng.integers(1, SEEDS, endpoint=True)), known.outfit.cell
        start, goal = cell_at(place, cell), cell_at(self.task.goal, cell)
        free = Free(known, start, goal)
        if start == goal or not free.state(*goal) or not free.state(*start):
            return np.empty(0, np.int32)
        information = _information(free, known.cells.shape, self.space)
        ends = [_state(information, end, place[2], self.space) for end in (start, goal)]
        path, vertices, exact = solved(information, ends, self.planner, self.iterations, seed)
        self.nodes += vertices
        points = [_point(state, self.space) for state in path] if exact else []
        walks = [walk(*a, *b, known.cells.shape[1]) for a, b in pairwise(points)]
        return np.concatenate([*walks, np.empty(0, np.int32)])


class Free:
    """Where the body has room; states are (row, column) in cells, the middle of a cell is its own row and column."""

    def __init__(self, known: RobotMap, start: Cell, goal: Cell) -> None:
        """On a known map, for a way between two cells."""
        self.gap, self.prices, self.ends = known.gap, prices_of(known.outfit), (start, goal)
        self.zone = zone_of(known.outfit)

    def state(self, row: float, column: float) -> bool:
        """Whether there is room at a point."""
        return self.motion(row, column, row, column)

    def motion(self, row: float, column: float, end_row: float, end_column: float) -> bool:
        """Whether there is room all along a straight line."""
        return roomy(self.gap, self.prices, self.ends, self.zone, row, column, end_row, end_column)


@kernel
def roomy(
    gap: Array, prices: Array, ends: tuple[Cell, Cell], zone: int,
    row: float, column: float, end_row: float, end_column: float,
) -> bool:  # fmt: skip
    """Whether all cells on a straight line have room, looked at in each half cell."""
    steps = int(2 * np.hypot(end_row - row, end_column - column)) + 1
    for k in range(steps + 1):
        r, c = row + k / steps * (end_row - row), column + k / steps * (end_column - column)
        if price_of(gap, prices, ends, zone, int(r + 0.5), int(c + 0.5)) == 0:
            return False
    return True


@kernel
def walk(row: float, column: float, end_row: float, end_column: float, width: int) -> Array:
    """The cells on a straight line, at each half cell: [n] int32, flat indices; one may come twice in a row."""
    steps = int(2 * np.hypot(end_row - row, end_column - column)) + 1
    cells = np.empty(steps + 1, np.int32)
    for k in range(steps + 1):
        r, c = row + k / steps * (end_row - row), column + k / steps * (end_column - column)
        cells[k] = int(r + 0.5) * width + int(c + 0.5)
    return cells


def _information(free: Free, extent: tuple[int, ...], space: str) -> Any:
    """The plane over the map, or its poses, with what is free in it."""
    bounds = base.RealVectorBounds(2)
    for axis, side in enumerate(extent):
        bounds.setLow(axis, -0.5 + EDGE)
        bounds.setHigh(axis, side - 0.5 - EDGE)
    made = base.SE2StateSpace() if space == "se2" else base.RealVectorStateSpace(2)
    made.setBounds(bounds)
    information = base.SpaceInformation(made)
    information.setStateValidityChecker(_FreeStates(information, free, space))
    information.setMotionValidator(_FreeMotions(information, free, space))
    information.setup()
    return information


def _state(information: Any, cell: Cell, heading: float, space: str) -> Any:
    state = information.allocState()
    if space == "se2":
        state.setX(float(cell[0]))
        state.setY(float(cell[1]))
        state.setYaw(heading)
    else:
        state[0], state[1] = float(cell[0]), float(cell[1])
    return state


def _point(state: Any, space: str) -> tuple[float, float]:
    return (state.getX(), state.getY()) if space == "se2" else (state[0], state[1])


class _FreeStates(base.StateValidityChecker):  # type: ignore[misc]  # OMPL has no types
    def __init__(self, information: Any, free: Free, space: str) -> None:
        super().__init__(information)
        self.free, self.space = free, space

    def isValid(self, state: Any) -> bool:  # noqa: N802  # OMPL calls it so
        return self.free.state(*_point(state, self.space))


class _FreeMotions(base.MotionValidator):  # type: ignore[misc]  # OMPL has no types
    def __init__(self, information: Any, free: Free, space: str) -> None:
        super().__init__(information)
        self.free, self.space = free, space

    def checkMotion(self, start: Any, end: Any) -> bool:  # noqa: N802  # OMPL calls it so
        return self.free.motion(*_point(start, self.space), *_point(end, self.space))
