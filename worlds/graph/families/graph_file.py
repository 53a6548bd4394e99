"""A graph from a file, such as a road network: GraphML and edge lists, as networkx and osmnx write them."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from pydantic import field_validator, model_validator

from fogbench.worlds.files import load
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.files import READERS, Read, read_graph
from fogbench.worlds.graph.layout import Graphs, fit
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.mistake import meant, near, one_of, shown
from fogbench.worlds.settings import MapFile
from fogbench.worlds.types import MapError

TRIES = 100
"""Times that `fogbench.worlds.graph.layout.fit` looks for a task before the graph is said to have none."""

ONE_TASK = "all episodes are one and the same task: intervals and tests tell of luck alone, not of other tasks"


class GraphFile(Graphs):
    """One connected graph; start and goal are uniform over its nodes, unless they are given.

    Edges are as long as the file says by `length` or `weight`; else, where nodes have coordinates (`x` and `y`), as the
    straight line, and 1 where they have none.
    """

    file: MapFile
    """A file that ends in `.graphml`; in `.edgelist`: two nodes a line, and the edge's weight or a dictionary; or in
    `.map`: a city of the Moving AI Lab, whose street crossings are the nodes (see `fogbench.worlds.graph.streets`)."""
    both_ways: bool = False
    """Whether the edges of a directed graph are read as leading both ways; else such a graph is refused."""
    start: str | None = None
    """A node as the file names it; with `goal`, the task of every episode."""
    goal: str | None = None
    """As `start`."""

    @field_validator("file")
    @classmethod
    def _of_a_known_form(cls, file: MapFile) -> MapFile:
        if file.suffix not in READERS:
            raise ValueError(f"a file that ends in {one_of(READERS).removeprefix('one of ')}")
        return file

    @model_validator(mode="after")
    def _whole_task(self) -> "GraphFile":
        if (self.start is None) != (self.goal is None):
            raise ValueError("start and goal, or neither")
        return self

    def sample(self, rng: np.random.Generator, episode: int, conditions: GraphConditions) -> GraphWorld:
        """A task that fits the conditions; `episode` plays no part.

        Raises:
            MapError: the file is broken, no task was found, or the fixed one does not fit.
        """
        del episode
        read = self._read()
        if self.start is not None and self.goal is not None:
            return self._fixed(read, self.start, self.goal, conditions)
        for _ in range(TRIES):
            found = fit(read.graph, conditions, rng)
            if found is not None:
                return found
        raise MapError(f"{self.file}: no task with {conditions.tasks.wanted()} was found")

    def words(self) -> str:
        """The digest of the file, and the other settings."""
        return f"GraphFile file={load(self.file).sha256} {self.model_dump_json(exclude={'file'})}"

    def notes(self) -> Sequence[str]:
        """Whether the task is fixed, and what of the file does not count."""
        told = [*self._read().notes, *([ONE_TASK] if self.start is not None else [])]
        return [f"{self.file}: {note}" for note in told]

    def _read(self) -> Read:
        return _kept(load(self.file), self.both_ways)

    def _fixed(self, read: Read, start: str, goal: str, conditions: GraphConditions) -> GraphWorld:
        ends = [self._node(read, end, name) for end, name in (("start", start), ("goal", goal))]
        found = conditions.world(read.graph, *ends)
        if found is None:
            told = "got the node of the start; expected another"
            if ends[0] != ends[1]:
                told = f"got a task out of bounds; expected {conditions.tasks.wanted()}"
            raise MapError(f"{self.file}: goal {shown(goal)}: {told}")
        return found

    def _node(self, read: Read, end: str, name: str) -> int:
        """The number of a node by its name."""
        if name not in read.numbers:
            told = meant(near(name, read.numbers))
            raise MapError(f"{self.file}: {end}: got {shown(name)}; expected a node of the file.{told}")
        return read.numbers[name]


_kept = lru_cache(maxsize=4)(read_graph)
