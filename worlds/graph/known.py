"""The graph as far as one agent has seen it: the one implementation that agents, judges, training and replays share.

Words used here
    N        nodes;  C  columns of a view
    visited  [N] bool, nodes where the agent was, so that all their edges are known
    heads    [N] int32, the first known link of each node; NONE: nothing is known of it, unless it was visited
    links    [any, 2] int32, a known edge as seen from one end: the node's next link or NONE, and the node that it leads
             to; an edge has two, one at each end
    lengths  [any] float64, of the links
    view     [N, C] float64, see `fogbench.worlds.graph.world`
"""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array, Observation

NONE = -1

EMPTY = 64
"""Links that a new graph has room for."""


class KnownGraph:
    """What an agent knows: nodes visited, edges seen and, where nodes are somewhere, where those in view are."""

    def __init__(self, extent: tuple[float, ...]) -> None:
        """Nothing is known yet of a graph of `extent` `(N,)`."""
        size = int(extent[0])
        self.visited = np.zeros(size, np.bool_)  # [N]
        self.heads = np.full(size, NONE, np.int32)  # [N]
        self.links = np.empty((EMPTY, 2), np.int32)
        self.lengths = np.empty(EMPTY)
        self.used = 0
        self.coordinates = np.empty((size, 0))  # [N, 2] once a view tells them, infinite where none has

    def update(self, observation: Observation) -> bool:
        """Take in what is seen from a node; whether it was not visited before."""
        place, view = observation.place, observation.view
        if self.visited[place]:
            return False
        while (used := fuse(*self.arrays, self.used, place, view)) > len(self.links):
            self._make_room(used)
        self.used = used
        if view.shape[1] > 1:
            seen = view[:, 1:]
            self.coordinates = np.minimum(self.coordinates, seen) if self.coordinates.size else seen.copy()
        return True

    @property
    def arrays(self) -> tuple[Array, Array, Array, Array]:
        """What searches go by: `visited`, `heads`, `links`, `lengths`."""
        return self.visited, self.heads, self.links, self.lengths

    @property
    def edges(self) -> Array:
        """[n, 2] int32, both ends of each known edge, the smaller first."""
        return edges(self.heads, self.links, self.used)

    @property
    def bytes(self) -> int:
        """Of all arrays."""
        return sum(a.nbytes for a in (self.visited, self.heads, self.links, self.lengths, self.coordinates))

    def _make_room(self, needed: int) -> None:
        room = max(needed, 2 * len(self.links))
        links, lengths = np.empty((room, 2), np.int32), np.empty(room)
        links[: self.used], lengths[: self.used] = self.links[: self.used], self.lengths[: self.used]
        self.links, self.lengths = links, lengths


@kernel
def fuse(
    visited: Array, heads: Array, links: Array, lengths: Array, used: int, place: int, view: Array
) -> int:  # fmt: skip
    """Write the view from a node that was not visited into a known graph.

    Returns:
        The links used now. Nothing is written where all edges in view need more than there is room for; then their sum.
    """
    near, count = np.empty(len(view), np.int64), 0
    for other in range(len(view)):
        if view[other, 0] < np.inf:
            near[count] = other
            count += 1
    if used + 2 * count > len(links):
        return used + 2 * count
    visited[place] = True
    for other in near[:count]:
        if visited[other]:
            continue  # the edge was seen from there
        for here, there in ((place, other), (other, place)):
            links[used, 0], links[used, 1], lengths[used] = heads[here], there, view[other, 0]
            heads[here] = used
            used += 1
    return used


@kernel
def edges(heads: Array, links: Array, used: int) -> Array:
    """Both ends of each known edge, the smaller first: [n, 2] int32."""
    found = np.empty((used // 2, 2), np.int32)
    count = 0
    for node in range(len(heads)):
        link = heads[node]
        while link != NONE:
            if node < links[link, 1]:
                found[count, 0], found[count, 1] = node, links[link, 1]
                count += 1
            link = links[link, 0]
    return found
