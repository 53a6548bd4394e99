"""Value iteration on a graph: its fixed point, in one pass (Dijkstra 1959).

An agent may end at a node, for a reward from 0 to 1, or go on along an edge, which costs by its length:

    V(s) = max(reward(s), max over neighbours t of exp(-step * length(s, t)) * V(t))

So V(s) is the reward of one node, its *end*, and what the way there costs. In logarithms that is a shortest path:
-log V(s) = price(end) + step * distance(s, end) with price = -log reward.

Words used here
    nodes, links    [B + 1] int64, where the nodes and the links of each of B graphs begin
    heads, next     as in `fogbench.worlds.graph.known`, of all graphs; numbers are those within a graph
"""

import numpy as np

from fogbench.worlds.graph.distances import pop, push
from fogbench.worlds.graph.known import NONE
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array


@kernel
def ends_of(
    nodes: Array, links: Array, heads: Array, following: Array, lengths: Array, prices: Array, step: float
) -> tuple[Array, Array]:  # fmt: skip
    """The end of each node, and how far it is.

    Args:
        nodes: [B + 1].
        links: [B + 1].
        heads: [all nodes] int32.
        following: [all links, 2] int32.
        lengths: [all links] float64.
        prices: [all nodes] float64; infinite where an agent cannot end.
        step: the cost of a length of 1, at least 0.

    Returns:
        [all nodes] int64, numbers among all nodes, NONE where no end can be reached; and distances [all nodes].
    """
    ends, distances = np.full(len(heads), NONE, np.int64), np.zeros(len(heads))
    for b in range(len(nodes) - 1):
        first, last, edge = nodes[b], nodes[b + 1], links[b]
        cost = prices[first:last].copy()
        heap = np.empty((last - first + links[b + 1] - edge + 1, 2))
        waiting = 0
        for node in range(last - first):
            if cost[node] < np.inf:
                ends[first + node] = first + node
                waiting = push(heap, waiting, (cost[node], float(node)))
        while waiting:
            least, node = heap[0, 0], int(heap[0, 1])
            waiting = pop(heap, waiting)
            if least > cost[node]:
                continue
            link = heads[first + node]
            while link != NONE:
                other, length = following[edge + link, 1], lengths[edge + link]
                if least + step * length < cost[other]:
                    cost[other] = least + step * length
                    ends[first + other] = ends[first + node]
                    distances[first + other] = distances[first + node] + length
                    waiting = push(heap, waiting, (cost[other], float(other)))
                link = following[edge + link, 0]
    return ends, distances
