"""A planner of another package."""

from typing import ClassVar

import numpy as np

from fogbench import Agent, Cell, KnownMap, Move, Observation, Positive, Route, Settings, Task, search


class Compass(Settings):
    """A* that gives up after some searches."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    patience: Positive = 100
    """Searches."""

    def start(self, task: Task, rng: np.random.Generator) -> Agent:
        """A fresh agent; it needs no luck."""
        del rng
        return CompassAgent(task, self.patience)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class CompassAgent:
    """One episode."""

    def __init__(self, task: Task, patience: int) -> None:
        """Nothing is known yet."""
        self.goal: Cell = task.goal
        self.patience = patience
        self.known = KnownMap(task.extent)
        self.expanded = 0

    def act(self, observation: Observation) -> Move | None:
        """The first move of a path on the known map."""
        self.patience -= 1
        self.known.update(observation)
        path, expanded = search(self.known.cells, observation.place, self.goal)
        self.expanded += expanded
        move: Move | None = Route(path, self.known.cells.shape[1]).move(observation.place, self.known.cells)
        return move if self.patience >= 0 else None

    def memory_bytes(self) -> int:
        """The known map."""
        return int(self.known.cells.nbytes)

    def search_nodes(self) -> int:
        """Cells expanded so far."""
        return self.expanded
