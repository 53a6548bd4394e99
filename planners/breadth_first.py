"""Breadth-first search by an agent that has to walk: the teacher of Khan et al. 2018 on graphs (section 4.3)."""

from typing import ClassVar

import numpy as np

from fogbench.planners.graph_search import first_steps, is_known
from fogbench.worlds.graph.known import KnownGraph
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import Observation, Task


class BreadthFirst(Settings):
    """Visits nodes in the order in which they were first seen, each by a shortest known way; the goal once it was seen.

    Of nodes that are seen at the same time, the one with the least number comes first.
    """

    kinds: ClassVar[frozenset[str]] = frozenset({"graph"})

    def start(self, task: Task, rng: np.random.Generator) -> "BreadthFirstAgent":
        """A fresh agent; it needs no luck."""
        del rng
        return BreadthFirstAgent(task)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class BreadthFirstAgent:
    """One episode."""

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.goal: int = task.goal
        self.known = KnownGraph(task.extent)
        self.queue = np.empty(len(self.known.heads), np.int32)  # [N], nodes as they were first seen
        self.first = self.last = 0  # of those that wait in it, and behind them
        self.expanded = 0

    def act(self, observation: Observation) -> int | None:
        """The node to go to; gives up where all was visited."""
        before = self.known.heads.copy()
        if self.known.update(observation):
            row = np.flatnonzero(np.isfinite(observation.view[:, 0]))
            fresh = [node for node in row.tolist() if not is_known(self.known.visited, before, node)]
            self.queue[self.last : self.last + len(fresh)] = fresh
            self.last += len(fresh)
        while self.first < self.last and self.known.visited[self.queue[self.first]]:
            self.first += 1
        seen = is_known(*self.known.arrays[:2], self.goal)
        if not seen and self.first == self.last:
            return None
        target = self.goal if seen else int(self.queue[self.first])
        steps, expanded = first_steps(*self.known.arrays, observation.place, target)
        self.expanded += expanded
        return int(steps[0])

    def memory_bytes(self) -> int:
        """The known graph and the queue."""
        return self.known.bytes + self.queue.nbytes

    def search_nodes(self) -> int:
        """Nodes expanded so far."""
        return self.expanded
