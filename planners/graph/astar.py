"""A* on the graph seen so far: from a node that was not visited, it supposes a straight edge to the goal.

Without coordinates nothing is known of how long that edge is. Then it is taken to have no length, and the agent goes
to the nearest node that it did not visit.

Words used here
    visited, heads, links, lengths    the known graph, see `fogbench.worlds.graph.known`
    coordinates  [N, 2] float64, of all nodes that were seen, and of the goal; [N, 0] without any
    g   length of the best way found to a node;  h  the straight line to the goal, SHORT of it;  f = g + h
"""

import numpy as np

from fogbench.planners.graph.agent import GraphAgent
from fogbench.planners.graph.search import is_known
from fogbench.worlds.graph.distances import pop, push
from fogbench.worlds.graph.known import NONE
from fogbench.worlds.graph.networks import SLACK
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array, Observation

SHORT = 1 - SLACK
"""An edge may be so much shorter than the straight line between its ends."""


class GraphAStarAgent(GraphAgent):
    """One episode."""

    def step(self, observation: Observation, *, fresh: bool) -> tuple[int, int]:
        """On a shortest way to the goal, as far as that is supposed."""
        del fresh
        return search(*self.known.arrays, self.known.coordinates, observation.place, self.goal)


@kernel
def straight(coordinates: Array, a: int, b: int) -> float:
    """The straight line between two nodes; 0 where there are no coordinates."""
    return float(np.sqrt(np.square(coordinates[a] - coordinates[b]).sum()))


@kernel
def exit_of(visited: Array, heads: Array, coordinates: Array, node: int, goal: int) -> float:
    """The length of the edge to the goal that is supposed at a node: only where it was seen and not visited."""
    if visited[node] or not is_known(visited, heads, node):
        return np.inf
    return straight(coordinates, node, goal)


@kernel
def search(
    visited: Array, heads: Array, links: Array, lengths: Array, coordinates: Array, place: int, goal: int
) -> tuple[int, int]:  # fmt: skip
    """The first step of a shortest way to the goal, -1 where none is known or supposed, and the nodes expanded.

    Of equal f the least h comes first, then the least number of a node.
    """
    g = np.full(len(heads), np.inf)
    parent = np.full(len(heads), NONE, np.int32)
    heap = np.empty((len(links) + len(heads) + 1, 3))
    g[place], heap[0], waiting, expanded = 0, (0.0, 0.0, float(place)), 1, 0
    while waiting:
        f, h, node = heap[0, 0], heap[0, 1], int(heap[0, 2])
        waiting = pop(heap, waiting)
        if f - h > g[node] + SLACK * g[node]:
            continue
        expanded += 1
        if node == goal:
            break
        supposed = exit_of(visited, heads, coordinates, node, goal)
        if g[node] + supposed < g[goal]:
            g[goal], parent[goal] = g[node] + supposed, node
            waiting = push(heap, waiting, (g[goal], 0.0, float(goal)))
        link = heads[node]
        while link != NONE:
            other, further = links[link, 1], g[node] + lengths[link]
            if further < g[other]:
                g[other], parent[other] = further, node
                h = SHORT * straight(coordinates, other, goal)
                waiting = push(heap, waiting, (further + h, h, float(other)))
            link = links[link, 0]
    step = goal if parent[goal] != NONE else NONE
    while step != NONE and parent[step] != place:
        step = parent[step]
    return step, expanded
