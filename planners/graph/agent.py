"""What planners on graphs share: the graph seen so far, and a search of it at each node."""

from abc import ABC, abstractmethod

from fogbench.worlds.graph.known import KnownGraph
from fogbench.worlds.types import Observation, Task


class GraphAgent(ABC):
    """One episode of a planner that plans at each node, on all that is known by then."""

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.goal: int = task.goal
        self.known = KnownGraph(task.extent)
        self.expanded = 0

    @abstractmethod
    def step(self, observation: Observation, *, fresh: bool) -> tuple[int, int]:
        """The node to go to, below 0 to give up; and the nodes expanded.

        Args:
            observation: the known graph has it already.
            fresh: whether the node was not visited before.
        """

    def act(self, observation: Observation) -> int | None:
        """The node to go to; gives up where all was visited."""
        step, expanded = self.step(observation, fresh=self.known.update(observation))
        self.expanded += expanded
        return step if step >= 0 else None

    def memory_bytes(self) -> int:
        """The known graph."""
        return self.known.bytes

    def search_nodes(self) -> int:
        """Nodes expanded so far."""
        return self.expanded
