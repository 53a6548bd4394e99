"""A* on the current view alone: what planning reaches without any memory."""

from typing import ClassVar

import numpy as np

from fogbench.planners.astar import glance
from fogbench.planners.robot.memoryless import MemorylessRobot
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import Agent, Cell, Move, Observation, Task


class Memoryless(Settings):
    """Plans anew at every step as if nothing but the current view had ever been seen."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid", "robot"})

    def start(self, task: Task, rng: np.random.Generator) -> Agent:
        """A fresh agent; it needs no luck."""
        del rng
        return MemorylessRobot(task) if task.kind == "robot" else MemorylessAgent(task)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class MemorylessAgent:
    """One episode of a planner that forgets."""

    def __init__(self, task: Task) -> None:
        """Plan towards the task's goal."""
        self.goal: Cell = task.goal
        self.extent = (int(task.extent[0]), int(task.extent[1]))
        self.expanded = 0

    def act(self, observation: Observation) -> Move | None:
        """The first move of a shortest path on the current view; gives up where the view leaves none."""
        move, expanded = glance(self.goal, self.extent, observation)
        self.expanded += expanded
        return move

    def memory_bytes(self) -> int:
        """Nothing is carried from one decision to the next."""
        return 0

    def search_nodes(self) -> int:
        """Cells expanded so far."""
        return self.expanded
