"""One graph for all episodes, with pairs of start and goal that were learned from or not (Khan et al. 2018)."""

from functools import lru_cache
from typing import Literal

import numpy as np

from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.families.random_graph import RandomGraph
from fogbench.worlds.graph.graph import Graph
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.settings import Seed
from fogbench.worlds.streams import stream
from fogbench.worlds.types import Array, MapError

PARTS = {"training": (0.0, 0.5), "validation": (0.5, 0.6), "test": (0.6, 1.0)}
"""Which share of all pairs, in an order drawn once, each part has."""


class FixedGraph(RandomGraph):
    """A random graph drawn once. Its pairs of start and goal are in three parts that share none.

    Of the pairs to learn from, and of those to be tried on meanwhile, each episode draws one; each test pair is played
    once.
    """

    number: Seed = 0
    """Another graph for another number."""
    pairs: Literal["training", "validation", "test"] = "test"
    """Which of them are played."""

    def extent(self) -> tuple[float, ...] | None:
        """Its nodes."""
        return (_graph(self).size,)

    def tasks(self, conditions: GraphConditions, most: int) -> int | None:
        """How many test pairs fit the conditions."""
        return min(len(_fitting(self, conditions)), most) if self.pairs == "test" else None

    def sample(self, rng: np.random.Generator, episode: int, conditions: GraphConditions) -> GraphWorld:
        """The test pair of that number, or any other pair that fits.

        Raises:
            MapError: there are not as many, or none fits.
        """
        fitting = _fitting(self, conditions)
        if self.pairs != "test" and len(fitting):
            episode = int(rng.integers(len(fitting)))
        if episode >= len(fitting):
            told = f"{len(fitting)} tasks with {conditions.tasks.wanted()} for {episode + 1} episodes"
            raise MapError(f"FixedGraph: {told}; set `episodes: {len(fitting)}`, or give a larger graph")
        return fitting[episode]


def part(family: FixedGraph) -> Array:
    """The pairs of a part, start and goal of each: [n, 2] int."""
    size = _graph(family).size
    pairs = stream(family.number, _plain(family).words(), "pairs", 0).permutation(size * (size - 1))
    first, last = (round(share * len(pairs)) for share in PARTS[family.pairs])
    start, other = np.divmod(pairs[first:last], size - 1)
    return np.stack([start, other + (other >= start)], 1)  # the goal is none of the start


def _plain(family: FixedGraph) -> FixedGraph:
    """The same for all parts."""
    return family.model_copy(update={"pairs": "test"})


def _graph(family: FixedGraph) -> Graph:
    return _drawn(_plain(family))


@lru_cache(maxsize=16)
def _drawn(family: FixedGraph) -> Graph:
    return family.draw(stream(family.number, family.words(), "graph", 0))


@lru_cache(maxsize=16)
def _fitting(family: FixedGraph, conditions: GraphConditions) -> list[GraphWorld]:
    """The worlds of the pairs of a part that fit."""
    worlds = (conditions.world(_graph(family), start, goal) for start, goal in part(family).tolist())
    return [world for world in worlds if world]
