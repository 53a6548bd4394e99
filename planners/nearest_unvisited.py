"""The reference on graphs: to the goal once it was seen, and before that to the nearest node that was not visited."""

from typing import ClassVar

import numpy as np

from fogbench.planners.graph_search import nearest_step
from fogbench.worlds.graph.known import KnownGraph
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


class NearestUnvisitedAgent:
    """One episode."""

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.goal: int = task.goal
        self.known = KnownGraph(task.extent)
        self.expanded = 0

    def act(self, observation: Observation) -> int | None:
        """The node to go to; gives up where all was visited."""
        self.known.update(observation)
        step, expanded = nearest_step(*self.known.arrays, observation.place, self.goal)
        self.expanded += expanded
        return step if step >= 0 else None

    def memory_bytes(self) -> int:
        """The known graph."""
        return self.known.bytes

    def search_nodes(self) -> int:
        """Nodes expanded so far."""
        return self.expanded
