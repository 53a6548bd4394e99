"""The reference of rings: the shorter way, as far as nothing on it is known to be cut."""

from typing import ClassVar

import numpy as np

from fogbench import Observation, Settings, Task
from ring_kind.world import KnownRing, Way, ahead


class Walker(Settings):
    """Takes the shorter way that is not known to be cut."""

    kinds: ClassVar[frozenset[str]] = frozenset({"ring"})

    def start(self, task: Task, rng: np.random.Generator) -> "WalkerAgent":
        """A fresh agent."""
        del rng
        return WalkerAgent(task)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class WalkerAgent:
    """One episode."""

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.goal: int = task.goal
        self.known = KnownRing(int(task.extent[0]))

    def act(self, observation: Observation) -> Way | None:
        """The shorter way; clockwise of equals."""
        self.known.update(observation)
        clockwise, back = ahead(self.known.links, observation.place, self.goal)
        if min(clockwise, back) == np.inf:
            return None
        return Way.CLOCKWISE if clockwise <= back else Way.BACK

    def memory_bytes(self) -> int:
        """The known ring."""
        return self.known.links.nbytes

    def search_nodes(self) -> int:
        """No search."""
        return 0
