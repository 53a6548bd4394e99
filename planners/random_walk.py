"""A random walk: the floor that every other agent should be above."""

from typing import Any, ClassVar

import numpy as np

from fogbench.worlds.settings import Settings
from fogbench.worlds.types import BLOCKED, DELTAS, Move, Observation, Task

MOVES = tuple(zip(Move, DELTAS, strict=True))


class RandomWalk(Settings):
    """Takes a uniformly random move that the current view does not show to be blocked.

    On a graph it goes to a uniformly random neighbour, or to the goal where that is one.
    """

    kinds: ClassVar[frozenset[str]] = frozenset({"grid", "graph"})

    def start(self, task: Task, rng: np.random.Generator) -> "RandomWalkAgent":
        """A fresh agent that draws its moves from `rng`."""
        return GraphWalkAgent(rng, task.goal) if task.kind == "graph" else RandomWalkAgent(rng)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class RandomWalkAgent:
    """One episode of a random walk."""

    def __init__(self, rng: np.random.Generator) -> None:
        """Draw from `rng`, once per decision."""
        self.rng = rng

    def act(self, observation: Observation) -> Any:
        """A random move; gives up where all four are seen to be blocked."""
        middle = len(observation.view) // 2
        luck = self.rng.random()  # drawn even where there is no choice, so that the stream never shifts
        view = observation.view
        moves = [move for move, (down, right) in MOVES if view[middle + down, middle + right] != BLOCKED]
        return moves[int(luck * len(moves))] if moves else None

    def memory_bytes(self) -> int:
        """Nothing is carried from one decision to the next."""
        return 0

    def search_nodes(self) -> int:
        """No search."""
        return 0


class GraphWalkAgent(RandomWalkAgent):
    """One episode on a graph."""

    def __init__(self, rng: np.random.Generator, goal: int) -> None:
        """Draw from `rng`, once per decision."""
        super().__init__(rng)
        self.goal = goal

    def act(self, observation: Observation) -> Any:
        """A random neighbour, or the goal; a connected graph has one at each node."""
        luck, row = self.rng.random(), np.flatnonzero(np.isfinite(observation.view[:, 0]))
        return self.goal if self.goal in row else int(row[int(luck * len(row))])
