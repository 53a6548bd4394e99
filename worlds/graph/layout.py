"""From a graph to a world: start and goal are drawn, connected, and inside the bounds."""

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np

from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.graph import Graph
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import MapError

GRAPHS, NODES_IN_ALL = 1000, 2**22
"""Graphs drawn before a family gives up, and nodes in all of them."""

PAIRS = 100
"""Pairs of start and goal drawn on a graph before another is drawn."""


class Graphs(Settings):
    """A family of graphs."""

    kinds: ClassVar[tuple[str, ...]] = ("graph",)

    def tasks(self, conditions: GraphConditions, most: int) -> int | None:
        """Any number."""
        del conditions, most
        return None

    def extent(self) -> tuple[float, ...] | None:
        """It differs, or a file has to be read to know."""
        return None


class DrawnGraphs(Graphs, ABC):
    """A family that draws a fresh graph for every episode; a subclass says how."""

    @abstractmethod
    def draw(self, rng: np.random.Generator) -> Graph:
        """One connected graph.

        Raises:
            MapError: there is none.
        """

    def sample(self, rng: np.random.Generator, episode: int, conditions: GraphConditions) -> GraphWorld:
        """The first drawn graph on which a task fits the conditions; `episode` plays no part.

        Raises:
            MapError: no graph can be drawn, or none had such a task.
        """
        del episode
        graphs = nodes = 0
        while graphs < GRAPHS and nodes < NODES_IN_ALL:
            graph = self.draw(rng)
            found = fit(graph, conditions, rng)
            if found is not None:
                return found
            graphs, nodes = graphs + 1, nodes + graph.size
        raise MapError(f"{type(self).__name__}: no task with {conditions.tasks.wanted()} was found on {graphs} graphs")


def fit(graph: Graph, conditions: GraphConditions, rng: np.random.Generator) -> GraphWorld | None:
    """A world on a graph with start and goal uniform over its nodes; None if none fits."""
    for _ in range(PAIRS if graph.size > 1 else 0):
        start, goal = rng.integers(graph.size, size=2).tolist()
        found = conditions.world(graph, start, goal)
        if found is not None:
            return found
    return None
