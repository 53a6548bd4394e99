"""Random graphs: a tree and more edges, or whatever a generator of networkx makes."""

from typing import Annotated, Any

import numpy as np
from pydantic import Field, StrictBool, model_validator

from fogbench.worlds.draws import below, luck
from fogbench.worlds.graph.generators import generated, refuse_unknown
from fogbench.worlds.graph.graph import EDGES, NODES, Graph, joined
from fogbench.worlds.graph.layout import DrawnGraphs
from fogbench.worlds.kernel import kernel
from fogbench.worlds.settings import Probability
from fogbench.worlds.types import Array

Plain = Annotated[StrictBool | int | float | bool | str, Field(union_mode="left_to_right")]
"""What a file says as text: a number if it can be one."""


class RandomGraph(DrawnGraphs):
    """A connected graph: a tree, uniform over all trees, and more edges, uniform over all pairs of nodes without one.

    Or one of a generator of networkx, of which those are drawn again that are not connected; its nodes are shuffled, so
    that their numbers tell nothing.
    """

    nodes: Annotated[int, Field(ge=2, le=NODES)] | None = None
    """How many; a generator is told them as its parameter `n`."""
    mean_degree: Annotated[float, Field(gt=0, le=NODES)] | None = None
    """Neighbours of a node on average; a tree has a little less than 2."""
    density: Probability | None = None
    """In place of that: edges as a share of all pairs of nodes."""
    generator: Annotated[str, Field(examples=["watts_strogatz_graph", "random_geometric_graph"])] | None = None
    """In place of both: a function of networkx that makes a graph."""
    parameters: dict[str, Plain | list[Plain]] = Field(default_factory=dict)
    """Of the generator, by their names there."""

    def __hash__(self) -> int:
        """Parameters may be lists, which have none."""
        return hash(self.words())

    @model_validator(mode="after")
    def _one_way(self) -> "RandomGraph":
        ways = [way for way in ("mean_degree", "density", "generator") if getattr(self, way) is not None]
        if len(ways) != 1:
            raise ValueError(f"one of mean_degree, density, generator (got {' and '.join(ways) or 'none'})")
        if self.generator:
            refuse_unknown(self.generator, self._told)
            return self
        if self.nodes is None:
            raise ValueError("nodes")
        if self.parameters:
            raise ValueError("no parameters, which are those of a generator")
        if self.edges > min(EDGES, self.nodes * (self.nodes - 1) // 2):
            most = f"{EDGES:,} edges" if self.edges > EDGES else "every pair of nodes once"
            raise ValueError(f"at most {most} (these settings make {self.edges:,} edges)")
        return self

    def extent(self) -> tuple[float, ...] | None:
        """Its nodes; those of a generator may differ."""
        return (self.nodes,) if self.nodes and not self.generator else None

    @property
    def edges(self) -> int:
        """Edges of a graph that no generator makes: those of a tree at least."""
        size = self.nodes or 0
        wanted = size * (self.mean_degree or 0) / 2 + size * (size - 1) / 2 * (self.density or 0)
        return max(size - 1, round(wanted))

    def draw(self, rng: np.random.Generator) -> Graph:
        """One graph.

        Raises:
            MapError: the generator makes none.
        """
        if self.generator:
            return generated(self.generator, self._told, rng)
        return joined(self.nodes or 0, tree_and_more(luck(rng), self.nodes or 0, self.edges))

    @property
    def _told(self) -> dict[str, Any]:
        """What a generator is told."""
        return self.parameters | ({} if self.nodes is None else {"n": self.nodes})


@kernel
def tree_and_more(luck: int, size: int, count: int) -> Array:
    """`count` different edges between `size` nodes, the first of them a tree: [count, 2] int32."""
    edges = np.empty((count, 2), np.int32)
    tree(luck, size, edges)
    taken = {np.int64(-1)}
    for a, b in edges[: size - 1]:
        taken.add(np.int64(min(a, b)) * size + max(a, b))
    filled = size - 1
    while filled < count:
        a, b = below(luck, size), below(luck, size)
        pair = np.int64(min(a, b)) * size + max(a, b)
        if a != b and pair not in taken:
            taken.add(pair)
            edges[filled, 0], edges[filled, 1] = a, b
            filled += 1
    return edges


@kernel
def tree(luck: int, size: int, edges: Array) -> None:
    """Draw a tree: its size - 1 edges, the first rows of `edges`.

    It is that of a drawn sequence of nodes (Pruefer 1918): the least leaf is cut off from the first node of the
    sequence, the least of what is left from the next, and so on; two nodes are left.
    """
    sequence, degrees = np.empty(size - 2, np.int32), np.ones(size, np.int32)
    for k in range(size - 2):
        sequence[k] = below(luck, size)
        degrees[sequence[k]] += 1
    passed, leaf = -1, -1  # all nodes up to `passed` were leaves before, or are not yet
    for k in range(size - 1):
        if leaf < 0:
            passed += 1
            while degrees[passed] != 1:
                passed += 1
            leaf = passed
        node = sequence[k] if k < size - 2 else size - 1
        edges[k, 0], edges[k, 1] = leaf, node
        degrees[node] -= 1
        leaf = node if degrees[node] == 1 and node < passed else -1
