"""Shortest ways on the graph seen so far, and all first steps of them (Dijkstra 1959).

Words used here
    visited, heads, links, lengths    the known graph, see `fogbench.worlds.graph.known`
    targets    the goal, once an edge to it is known; before that, all nodes that were seen and not visited
"""

import numpy as np

from fogbench.worlds.graph.distances import pop, push
from fogbench.worlds.graph.known import NONE
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

ROUNDING = 1e-9
"""By which share two sums of the same lengths may differ."""


@kernel
def is_known(visited: Array, heads: Array, node: int) -> bool:
    """Whether an edge to a node is known."""
    return bool(visited[node] or heads[node] != NONE)


@kernel
def nearest(
    visited: Array, heads: Array, links: Array, lengths: Array, place: int, goal: int
) -> tuple[Array, int]:  # fmt: skip
    """The first steps of all shortest known ways to the nearest targets.

    Returns:
        [n] int32, neighbours of `place` in rising order, none where no target is known; and the nodes expanded.
    """
    if is_known(visited, heads, goal):
        return first_steps(visited, heads, links, lengths, place, goal)
    return first_steps(visited, heads, links, lengths, place, -1)


@kernel
def nearest_step(
    visited: Array, heads: Array, links: Array, lengths: Array, place: int, goal: int
) -> tuple[int, int]:  # fmt: skip
    """Of the steps of `nearest` the one with the least number, NONE where there is none; and the nodes expanded."""
    steps, expanded = nearest(visited, heads, links, lengths, place, goal)
    return int(steps[0]) if len(steps) else NONE, expanded


@kernel
def first_steps(
    visited: Array, heads: Array, links: Array, lengths: Array, place: int, target: int
) -> tuple[Array, int]:  # fmt: skip
    """The first steps of all shortest known ways to one node, or, for -1, to the nearest of those not visited."""
    found = np.full(len(heads), np.inf)
    heap = np.empty((len(links) + 1, 2))
    settled = np.empty(len(heads), np.int32)
    found[place], heap[0, 0], heap[0, 1] = 0, 0, place
    waiting, count, limit = 1, 0, np.inf
    while waiting and heap[0, 0] <= limit:
        length, node = heap[0, 0], int(heap[0, 1])
        waiting = pop(heap, waiting)
        if length > found[node]:
            continue
        settled[count] = node
        count += 1
        if node != place and (node == target or (target < 0 and not visited[node])):
            limit = min(limit, length * (1 + ROUNDING))
            continue
        link = heads[node]
        while link != NONE:
            other, further = links[link, 1], length + lengths[link]
            if further < found[other]:
                found[other] = further
                waiting = push(heap, waiting, (further, float(other)))
            link = links[link, 0]
    return _back(visited, heads, links, lengths, place, target, found, settled[:count]), count


@kernel
def _back(
    visited: Array, heads: Array, links: Array, lengths: Array, place: int, target: int, found: Array, settled: Array
) -> Array:  # fmt: skip
    """The steps from a place that begin a shortest way to a settled target, once all nodes as near are settled."""
    leads = np.zeros(len(heads), np.bool_)  # whether a shortest way to a target goes through a node
    for k in range(len(settled) - 1, -1, -1):
        node = settled[k]
        if node != place and (node == target or (target < 0 and not visited[node])):
            leads[node] = True
            continue
        link = heads[node]
        while link != NONE:
            other = links[link, 1]
            if leads[other] and found[node] + lengths[link] <= found[other] * (1 + ROUNDING):
                leads[node] = True
            link = links[link, 0]
    steps, count = np.empty_like(settled), 0
    link = heads[place]
    while link != NONE:
        other = links[link, 1]
        if leads[other] and lengths[link] <= found[other] * (1 + ROUNDING):
            steps[count] = other
            count += 1
        link = links[link, 0]
    return np.sort(steps[:count])
