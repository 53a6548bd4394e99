"""Breadth-first search by an agent that has to walk: the teacher of Khan et al. 2018 on graphs (section 4.3)."""

from typing import ClassVar

import numpy as np

from fogbench.planners.graph.agent import GraphAgent
from fogbench.planners.graph.search import first_steps, is_known
from fogbench.worlds.graph.known import NONE
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


class BreadthFirstAgent(GraphAgent):
    """One episode."""

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        super().__init__(task)
        self.queue = np.empty(len(self.known.heads), np.int32)  # [N], nodes as they were first seen
        self.first = self.last = 0  # of those that wait in it, and behind them

    def step(self, observation: Observation, *, fresh: bool) -> tuple[int, int]:
        """To the node that waits longest, or to the goal."""
        if fresh:
            row = np.flatnonzero(np.isfinite(observation.view[:, 0]))
            seen = [node for node in row.tolist() if self._was_just_seen(node)]
            self.queue[self.last : self.last + len(seen)] = seen
            self.last += len(seen)
        while self.first < self.last and self.known.visited[self.queue[self.first]]:
            self.first += 1
        target = self.goal if is_known(*self.known.arrays[:2], self.goal) else self._next()
        if target == NONE:
            return NONE, 0
        steps, expanded = first_steps(*self.known.arrays, observation.place, target)
        return int(steps[0]), expanded

    def memory_bytes(self) -> int:
        """The known graph and the queue."""
        return super().memory_bytes() + self.queue.nbytes

    def _was_just_seen(self, node: int) -> bool:
        """Whether a neighbour has no known edge but that to the node of now."""
        return not self.known.visited[node] and self.known.links[self.known.heads[node], 0] == NONE

    def _next(self) -> int:
        """The node that waits longest; NONE where none does."""
        return int(self.queue[self.first]) if self.first < self.last else NONE
