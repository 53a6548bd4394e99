"""Frontier exploration (after Yamauchi 1997): to that edge of known free space from which the goal seems nearest."""

from typing import ClassVar

import numpy as np

from fogbench.planners.dstar_lite import DStarLiteAgent
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import Task


class Frontier(Settings):
    """Walks through known free cells to the frontier cell with the least path cost plus Manhattan distance to the goal.

    A frontier cell is known to be free and has an unknown neighbour. Once the goal is known to be free, it competes at
    its path cost. The searches are those of D* Lite, on the graph that the file `incremental` calls not optimist.
    """

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    def start(self, task: Task, rng: np.random.Generator) -> DStarLiteAgent:
        """A fresh agent; it needs no luck."""
        del rng
        return DStarLiteAgent(task, optimist=False)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0
