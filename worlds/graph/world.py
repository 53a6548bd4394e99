"""The graph world: an agent at a node sees the edges there, and goes to a node of its choice.

Words used here
    N      nodes
    C      1; 3 where nodes have coordinates
    view   [N, C] float64: in the first column the length of the edge that leads to each node, infinite where none
           does; in the others x and y of the agent's node, of its neighbours and of the goal, infinite for all others
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import inf
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fogbench.worlds.graph.distances import distances
from fogbench.worlds.graph.graph import Graph
from fogbench.worlds.graph.known import KnownGraph
from fogbench.worlds.graph.placing import drawn_at
from fogbench.worlds.kernel import kernel
from fogbench.worlds.picture import Dots, Lines, Picture
from fogbench.worlds.types import Array, Observation, Step, Task

if TYPE_CHECKING:
    from fogbench.worlds.batch import Batch

COVARIATES = ("nodes", "mean_degree", "hops")
"""What `GraphWorld.covariates` tells."""


class GraphState(NamedTuple):
    """Where an episode stands."""

    step: int
    place: int
    blocked: bool
    """Whether the last action was no neighbour."""


@dataclass(frozen=True, eq=False)
class GraphWorld:
    """One graph with one task."""

    graph: Graph
    start: int
    task: Task
    slip: float
    """Probability that the agent stays where it is."""
    optimum: float
    hops: int
    """The fewest edges from start to goal."""

    @classmethod
    def side_by_side(cls, slots: int) -> "Batch":
        """A batch of such worlds; it is named by a string, for no episode depends on it."""
        batch: Batch = resolve_name("fogbench.worlds.graph.batch:GraphBatch")(slots)
        return batch

    def reset(self) -> GraphState:
        """The state before the first decision."""
        return GraphState(0, self.start, blocked=False)

    def sense(self, state: GraphState, rng: np.random.Generator) -> Observation:
        """The edges of the agent's node, and coordinates where there are any; nothing is drawn."""
        del rng
        graph = self.graph
        view = graph.unseen.copy()
        look(graph.starts, graph.ends, graph.lengths, graph.coordinates, state.place, self.task.goal, view)
        view.setflags(write=False)
        return Observation(state.step, state.place, view[:], state.blocked)

    def step(self, state: GraphState, action: Any, rng: np.random.Generator) -> Step:
        """Go to a neighbour, or stay: after a slip, or for a node that is none; with slips, one number is drawn.

        Raises:
            TypeError: `action` is not a node.
        """
        graph = self.graph
        if type(action) is not int or not 0 <= action < graph.size:
            got = f"act returned {action!r} ({type(action).__name__})"
            raise TypeError(f"{got}; expected a node, an int from 0 to {graph.size - 1}, or None")
        slipped = self.slip and rng.random() < self.slip
        length = length_of(graph.starts, graph.ends, graph.lengths, state.place, action)
        blocked = length == inf
        place, gone = (state.place, 0.0) if blocked or slipped else (action, length)
        return Step(GraphState(state.step + 1, place, blocked), gone, False, place == self.task.goal)

    def shortest(self) -> float:
        """Length of the optimal path on the full graph."""
        return self.optimum

    def straight(self) -> float:
        """The straight line from start to goal; 0 where nodes have no coordinates, for then nothing is known of it."""
        return min(self.graph.straight(self.start, self.task.goal), self.optimum)  # which is rounded otherwise

    def covariates(self) -> Mapping[str, float]:
        """Nodes, mean degree, and the fewest edges from start to goal."""
        size = self.graph.size
        return dict(zip(COVARIATES, (float(size), len(self.graph.ends) / size, float(self.hops)), strict=True))

    def remaining(self, state: GraphState) -> float:
        """Length of the optimal path from here on the full graph."""
        return float(to_goal(self)[state.place])

    def known(self) -> KnownGraph:
        """The graph of an agent that has seen nothing."""
        return KnownGraph(self.task.extent)

    def action(self, *numbers: float) -> int:
        """The node of a recorded number."""
        (number,) = numbers
        return int(number)

    def picture(self, known: KnownGraph, observation: Observation, path: Sequence[int]) -> Picture:
        """Nodes where they are, or where a drawing has them, and the edges: all, those known, those in view."""
        at, extent = drawn_at(self.graph)  # [N, 2]
        place, edges, nodes = observation.place, known.edges, Dots(at)
        seen = np.union1d(edges, np.flatnonzero(known.visited))
        row = self.graph.row(place)
        return Picture(
            extent=extent,
            truth=(Lines(at[self.graph.lines]), nodes),
            known=(Lines(at[edges]), Dots(at[seen])),
            view=Lines(at[np.stack([np.full_like(row, place), row], 1)]),
            path=Dots(at[list(path)]),
            agent=Dots(at[[place]]),
            goal=Dots(at[[self.task.goal]]),
        )


@lru_cache(maxsize=4)
def to_goal(world: GraphWorld) -> Array:
    """[N] float64, distances to the goal on the full graph; those of the last few worlds are kept."""
    return distances(world.graph, world.task.goal)


@kernel
def look(
    starts: Array, ends: Array, lengths: Array, coordinates: Array, place: int, goal: int, view: Array
) -> None:  # fmt: skip
    """Write what is seen from a node into a view of which all is infinite."""
    for k in range(starts[place], starts[place + 1]):
        view[ends[k], 0] = lengths[k]
        _locate(coordinates, ends[k], view)
    _locate(coordinates, place, view)
    _locate(coordinates, goal, view)


@kernel
def _locate(coordinates: Array, node: int, view: Array) -> None:
    """Write where a node is, if it is anywhere."""
    for axis in range(coordinates.shape[1]):  # faster than slices, which are empty on most graphs
        view[node, 1 + axis] = coordinates[node, axis]


@kernel
def length_of(starts: Array, ends: Array, lengths: Array, a: int, b: int) -> float:
    """The length of the edge between two nodes; infinite where there is none."""
    found: float = np.inf
    for k in range(starts[a], starts[a + 1]):
        if ends[k] == b:
            found = lengths[k]
    return found
