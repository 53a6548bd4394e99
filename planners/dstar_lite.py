"""D* Lite: the same paths as A* on the map seen so far, by repairing the last search (Koenig & Likhachev 2002)."""

from typing import ClassVar

import numpy as np

from fogbench.planners.astar import glance
from fogbench.planners.graph.dstar_lite import GraphDStarLiteAgent
from fogbench.planners.incremental import EMPTY, descend, replan
from fogbench.planners.robot.agent import RobotAgent
from fogbench.planners.robot.repairing import DStarLiteGuide
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.maps.distances import FAR
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import Agent, Array, Cell, Move, Observation, Task


class DStarLite(Settings):
    """Follows a shortest path on the known map, where unknown counts as free."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid", "graph", "robot"})

    def start(self, task: Task, rng: np.random.Generator) -> Agent:
        """A fresh agent; it needs no luck."""
        del rng
        if task.kind == "graph":
            return GraphDStarLiteAgent(task)
        if task.kind == "robot":
            return RobotAgent(task, DStarLiteGuide(task))
        return DStarLiteAgent(task, optimist=True)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class DStarLiteAgent:
    """One episode of incremental search; the file `incremental` explains its letters and the word `optimist`."""

    def __init__(self, task: Task, *, optimist: bool) -> None:
        """Plan towards the task's goal."""
        self.goal: Cell = task.goal
        self.optimist = optimist
        self.known = KnownMap(task.extent)
        extent = self.known.cells.shape
        self.g: Array = np.full(extent, FAR, np.int32)  # [H, W]
        self.rhs: Array = np.full(extent, FAR, np.int32)  # [H, W]
        self.queue: Array = np.zeros((EMPTY, 4), np.int32)  # U, [capacity, 4]
        self.at: Array = np.zeros(extent, np.int32)  # [H, W]
        self.last, self.k_m = self.goal, 0
        self.expanded = 0
        self._repair(self.goal, np.array([self.goal[0] * extent[1] + self.goal[1]], np.int32))  # opens the search

    def act(self, observation: Observation) -> Move | None:
        """The next move of a shortest path; where the known map leaves none, of a path on the current view alone."""
        self._repair(observation.place, self.known.update(observation))
        move = descend(self.g, self.rhs, observation.place)
        if move >= 0:
            return Move(move)
        glimpsed, expanded = glance(self.goal, self.g.shape, observation)
        self.expanded += expanded
        return glimpsed

    def memory_bytes(self) -> int:
        """The known map, the costs and the queue."""
        return sum(array.nbytes for array in (self.known.cells, self.g, self.rhs, self.queue, self.at))

    def search_nodes(self) -> int:
        """Cells expanded so far."""
        return self.expanded

    def _repair(self, start: Cell, touched: Array) -> None:
        self.queue, self.last, self.k_m, expanded = replan(
            self.known.cells,
            self.g,
            self.rhs,
            self.queue,
            self.at,
            self.goal,
            self.optimist,
            touched,
            start,
            self.last,
            self.k_m,
        )
        self.expanded += expanded
