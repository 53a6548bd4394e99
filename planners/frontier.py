"""Frontier exploration (after Yamauchi 1997): to that edge of known free space from which the goal seems nearest."""

from typing import ClassVar

import numpy as np

from fogbench.planners.dstar_lite import DStarLiteAgent
from fogbench.planners.robot.agent import RobotAgent
from fogbench.planners.robot.guides import AStarGuide
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import Agent, Task


class Frontier(Settings):
    """Walks through known free cells to the frontier cell with the least path cost plus Manhattan distance to the goal.

    A frontier cell is known to be free and has an unknown neighbour. Once the goal is known to be free, it competes at
    its path cost. On a grid the searches are those of D* Lite, on the graph that the file `incremental` calls not
    optimist; a robot searches anew.
    """

    kinds: ClassVar[frozenset[str]] = frozenset({"grid", "robot"})

    def start(self, task: Task, rng: np.random.Generator) -> Agent:
        """A fresh agent; it needs no luck."""
        del rng
        if task.kind == "robot":
            return RobotAgent(task, AStarGuide(task, eager=True, optimist=False))
        return DStarLiteAgent(task, optimist=False)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0
