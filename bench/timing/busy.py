"""An agent whose decisions take CPU time, always the same amount of work."""

from typing import ClassVar

import numpy as np

from fogbench.worlds.settings import Positive, Settings
from fogbench.worlds.types import Move, Observation, Task


class Busy(Settings):
    """Counts, and goes up and down."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    count: Positive
    """How far it counts before each move."""

    def start(self, task: Task, rng: np.random.Generator) -> "BusyAgent":
        """A fresh agent; it needs no luck."""
        del task, rng
        return BusyAgent(self.count)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class BusyAgent:
    """One episode of counting."""

    def __init__(self, count: int) -> None:
        """Count to `count` before each move."""
        self.count = count

    def act(self, observation: Observation) -> Move:
        """Up after an even number of steps, else down."""
        sum(range(self.count))
        return Move.DOWN if observation.step % 2 else Move.UP

    def memory_bytes(self) -> int:
        """Nothing is carried from one decision to the next."""
        return 0

    def search_nodes(self) -> int:
        """No search."""
        return 0
