"""A connected graph of nodes 0 to N - 1, as the rows of its adjacency matrix.

Words used here
    N, M      nodes and edges
    row       the neighbours of a node, in rising order
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

NODES, EDGES = 100_000, 1_000_000
"""Of a graph at most."""


@dataclass(frozen=True, eq=False)
class Graph:
    """Edges lead both ways; no node leads to itself, and no two edges join the same nodes."""

    starts: Array
    """[N + 1] int32, where the row of each node begins in `ends`, and where the last row ends."""
    ends: Array
    """[2 M] int32, all rows."""
    lengths: Array
    """[2 M] float64, above 0, of the edges to `ends`."""
    coordinates: Array
    """[N, 2] float64, x and y of each node in the unit of lengths; [N, 0] for nodes that are nowhere."""
    unit: bool
    """Whether all edges have length 1."""

    @property
    def size(self) -> int:
        """N."""
        return len(self.starts) - 1

    def row(self, node: int) -> Array:
        """The neighbours of a node [n]."""
        row: Array = self.ends[self.starts[node] : self.starts[node + 1]]
        return row

    def straight(self, a: int, b: int) -> float:
        """The length of the straight line between two nodes; 0 where nodes are nowhere."""
        return float(np.sqrt(np.square(self.coordinates[a] - self.coordinates[b]).sum()))

    @cached_property
    def unseen(self) -> Array:
        """[N, C] float64, a view that shows nothing, see `fogbench.worlds.graph.world`: all is infinite."""
        return np.full((self.size, 1 + self.coordinates.shape[1]), np.inf)

    @cached_property
    def lines(self) -> Array:
        """[M, 2] int32, both ends of each edge, the smaller first."""
        nodes = np.repeat(np.arange(self.size, dtype=np.int32), np.diff(self.starts))
        return np.stack([nodes, self.ends], 1)[nodes < self.ends]


def joined(size: int, edges: Array, lengths: Array | None = None, coordinates: Array | None = None) -> Graph:
    """The graph of some edges [M, 2] int32 between `size` nodes, each edge once; it need not be connected.

    Args:
        size: N.
        edges: both ends of each.
        lengths: [M] float64; None: each is 1.
        coordinates: [N, 2] float64; None: nodes are nowhere.
    """
    weights = np.ones(len(edges)) if lengths is None else lengths
    arrays = rows(size, np.ascontiguousarray(edges, np.int32), weights)
    unit = lengths is None or bool((lengths == 1).all())
    graph = Graph(*arrays, np.empty((size, 0)) if coordinates is None else coordinates, unit)
    for array in (graph.starts, graph.ends, graph.lengths, graph.coordinates):
        array.setflags(write=False)
    return graph


@kernel
def rows(size: int, edges: Array, weights: Array) -> tuple[Array, Array, Array]:
    """`starts`, `ends` and `lengths` of a `Graph`.

    Edges are laid into the rows of their ends, in any order; of a symmetric matrix the columns, read in order, are rows
    in order.
    """
    starts = np.zeros(size + 1, np.int32)
    for a, b in edges:
        starts[a + 1] += 1
        starts[b + 1] += 1
    for node in range(size):
        starts[node + 1] += starts[node]
    mixed, mixed_lengths = np.empty(2 * len(edges), np.int32), np.empty(2 * len(edges), np.float64)
    filled = starts[:-1].copy()
    for k in range(len(edges)):
        for side in range(2):
            node = edges[k, side]
            mixed[filled[node]], mixed_lengths[filled[node]] = edges[k, 1 - side], weights[k]
            filled[node] += 1
    ends, lengths = np.empty_like(mixed), np.empty_like(mixed_lengths)
    filled = starts[:-1].copy()
    for node in range(size):
        for k in range(starts[node], starts[node + 1]):
            other = mixed[k]
            ends[filled[other]], lengths[filled[other]] = node, mixed_lengths[k]
            filled[other] += 1
    return starts, ends, lengths
