"""RRT* and other sampling planners of OMPL, in the plane over the map seen so far (Karaman & Frazzoli 2011).

Words used here
    state      a point (row, column) of the plane, in cells; the centre of a cell is its own row and column
    motion     the straight line between two states, see `fogbench.planners.segment`
    iteration  one pass of a planner's loop: it asks its termination condition once
"""

from itertools import pairwise
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import numpy as np
from ompl import base
from pydantic import Field

from fogbench.planners.astar import glance
from fogbench.planners.robot.agent import RobotAgent
from fogbench.planners.robot.sampling import RrtStarGuide
from fogbench.planners.route import Route
from fogbench.planners.sampling import SEEDS, solved
from fogbench.planners.segment import PARTS, clear, walk
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import BLOCKED, Agent, Array, Cell, Move, Observation, Task


class RrtStar(Settings):
    """Plans in the plane, unknown counts as free, and follows its path in moves until a blocked cell cuts it."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid", "robot"})

    # Left out: PRM and PRM* hang with checks in Python, FMT and BFMT count samples, BIT* leaks the map with every tree
    # that is counted, and AORRTC has no tree to count.
    planner: Literal[
        "RRTstar", "InformedRRTstar", "SORRTstar", "RRT", "RRTConnect", "KPIECE1", "BKPIECE1", "LBKPIECE1"
    ] = "RRTstar"
    """OMPL's name of the planner, with OMPL's parameters; those named RRT* are tuned in `plan`."""
    iterations: Annotated[int, Field(ge=1, le=1_000_000)] = 2000
    """Iterations of a plan, after which the best path so far is followed."""
    space: Literal["plane", "se2"] = "plane"
    """What a robot plans in: points, or poses, whose headings count as well; on a grid it is the plane."""

    def start(self, task: Task, rng: np.random.Generator) -> Agent:
        """A fresh agent; every plan draws its seed from `rng`."""
        if task.kind == "robot":
            return RobotAgent(task, RrtStarGuide(task, self.planner, self.iterations, self.space, rng))
        return RrtStarAgent(task, self, rng)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class RrtStarAgent:
    """One episode of planning in the plane."""

    def __init__(self, task: Task, settings: RrtStar, rng: np.random.Generator) -> None:
        """Plan towards the task's goal."""
        self.goal: Cell = task.goal
        self.settings = settings
        self.rng = rng
        self.known = KnownMap(task.extent)
        self.route = Route(np.empty(0, np.int32), self.known.cells.shape[1])
        self.nodes = 0

    def act(self, observation: Observation) -> Move | None:
        """The next move of the path; where there is no plan, of a shortest path on the current view alone."""
        place, cells = observation.place, self.known.cells
        self.known.update(observation)
        move = self.route.move(place, cells)
        if move is None and place != self.goal and cells[self.goal] != BLOCKED:
            self._plan(place)
            move = self.route.move(place, cells)
        if move is None:
            move, expanded = glance(self.goal, cells.shape, observation)
            self.nodes += expanded
        return move

    def _plan(self, place: Cell) -> None:
        seed = int(self.rng.integers(1, SEEDS, endpoint=True))
        found = plan(self.known.cells, place, self.goal, self.settings, seed)
        self.route = Route(found.cells, self.route.width)
        self.nodes += found.vertices

    def memory_bytes(self) -> int:
        """The known map and the path; the tree does not outlive its plan."""
        return self.known.cells.nbytes + self.route.cells.nbytes

    def search_nodes(self) -> int:
        """Vertices of all plans' trees so far, and the cells expanded where there was no plan."""
        return self.nodes


class Plan(NamedTuple):
    """What OMPL has found."""

    states: Array
    """[n, 2] float64, the path from the start on; empty if there is none."""
    cells: Array
    """[m] int32, flat indices of the cells that the path crosses, in order."""
    vertices: int
    """Of the planner's tree or trees, at the end."""
    exact: bool
    """Whether the path ends at the goal; if not, it leads to the state nearest to it that was reached."""

    @property
    def length(self) -> float:
        """Euclidean length of the path [cells]."""
        return float(np.linalg.norm(np.diff(self.states, axis=0), axis=1).sum())


def plan(known: Array, start: Cell, goal: Cell, settings: RrtStar, seed: int) -> Plan:
    """One run of a planner; the same arguments give the same plan.

    Args:
        known: [H, W] uint8 of UNKNOWN, FREE, BLOCKED.
        start: a cell that is not blocked.
        goal: another cell that is not blocked; OMPL would wait for a blocked one to open.
        settings: the planner and its iterations.
        seed: from 1 to SEEDS.
    """
    information = _information(known)
    ends = [information.allocState(), information.allocState()]
    for state, cell in zip(ends, (start, goal), strict=True):
        state[0], state[1] = float(cell[0]), float(cell[1])
    path, vertices, exact = solved(information, ends, settings.planner, settings.iterations, seed)
    states = np.array([(state[0], state[1]) for state in path], np.float64).reshape(-1, 2)  # [n, 2]
    return Plan(states, _cells(known, states), vertices, exact)


def _information(known: Array) -> Any:
    """The plane over the map, from the first part's middle to the last's, with what is blocked in it."""
    bounds = base.RealVectorBounds(2)
    for axis, side in enumerate(known.shape):
        bounds.setLow(axis, -0.5 + 0.5 / PARTS)
        bounds.setHigh(axis, side - 0.5 - 0.5 / PARTS)
    space = base.RealVectorStateSpace(2)
    space.setBounds(bounds)
    information = base.SpaceInformation(space)
    information.setStateValidityChecker(_FreeStates(information, known))
    information.setMotionValidator(_FreeMotions(information, known))
    information.setup()
    return information


class _FreeStates(base.StateValidityChecker):  # type: ignore[misc]  # OMPL has no types
    def __init__(self, information: Any, known: Array) -> None:
        super().__init__(information)
        self.known = known

    def isValid(self, state: Any) -> bool:  # noqa: N802  # OMPL calls it so
        return clear(self.known, state[0], state[1], state[0], state[1])


class _FreeMotions(base.MotionValidator):  # type: ignore[misc]  # OMPL has no types
    def __init__(self, information: Any, known: Array) -> None:
        super().__init__(information)
        self.known = known

    def checkMotion(self, start: Any, end: Any) -> bool:  # noqa: N802  # OMPL calls it so
        return clear(self.known, start[0], start[1], end[0], end[1])


def _cells(known: Array, states: Array) -> Array:
    """The walks of the motions, one after the other; each begins in the cell where the last one has ended."""
    walks = [walk(known, *start, *end) for start, end in pairwise(states)]
    return np.concatenate([cells[k > 0 :] for k, cells in enumerate(walks)] or [np.empty(0, np.int32)])  # [m]
