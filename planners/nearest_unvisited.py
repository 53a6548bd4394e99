"""The reference on graphs: to the goal once it was seen, and before that to the nearest node that was not visited."""

from typing import ClassVar

import numpy as np

from fogbench.planners.graph.agent import GraphAgent
from fogbench.planners.graph.search import nearest_step
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import Observation, Task


class NearestUnvisited(Settings):
    """Takes the first step of a shortest known way; of several, to the node with the least number."""

    kinds: ClassVar[frozenset[str]] = frozenset({"graph"})

    def start(self, task: Task, rng: np.random.Generator) -> "NearestUnvisitedAgent":
        """A fresh agent; it needs no luck."""
        del rng
        return NearestUnvisitedAgent(task)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class NearestUnvisitedAgent(GraphAgent):
    """One episode."""

    def step(self, observation: Observation, *, fresh: bool) -> tuple[int, int]:
        """To the goal, or to a node that was not visited."""
        del fresh
        return nearest_step(*self.known.arrays, observation.place, self.goal)
