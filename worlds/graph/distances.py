"""Shortest paths on a whole graph: by edges (breadth first), and by their lengths (Dijkstra 1959)."""

import numpy as np

from fogbench.worlds.graph.graph import Graph
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

FAR = 2**30
"""Edges to a node that no path leads to."""


def distances(graph: Graph, node: int) -> Array:
    """Lengths of the shortest paths between a node and all others: [N] float64, infinite where none leads."""
    if graph.unit:
        edges = hops(graph.starts, graph.ends, node)
        return np.where(edges == FAR, np.inf, edges)
    return lengths_from(graph.starts, graph.ends, graph.lengths, node)


@kernel
def hops(starts: Array, ends: Array, node: int) -> Array:
    """The fewest edges between a node and all others: [N] int32, FAR where no path leads."""
    found = np.full(len(starts) - 1, FAR, np.int32)
    queue = np.empty(len(found), np.int32)
    found[node], queue[0], last = 0, node, 1
    for first in range(len(found)):
        if first == last:
            break
        here = queue[first]
        for k in range(starts[here], starts[here + 1]):
            if found[ends[k]] == FAR:
                found[ends[k]] = found[here] + 1
                queue[last] = ends[k]
                last += 1
    return found


@kernel
def lengths_from(starts: Array, ends: Array, lengths: Array, node: int) -> Array:
    """The same by lengths: [N] float64."""
    found = np.full(len(starts) - 1, np.inf)
    heap = np.empty((len(ends) + 1, 2))
    found[node], heap[0, 0], heap[0, 1], waiting = 0, 0, node, 1
    while waiting:
        length, here = heap[0, 0], int(heap[0, 1])
        waiting = pop(heap, waiting)
        if length > found[here]:
            continue
        for k in range(starts[here], starts[here + 1]):
            if length + lengths[k] < found[ends[k]]:
                found[ends[k]] = length + lengths[k]
                waiting = push(heap, waiting, (found[ends[k]], float(ends[k])))
    return found


@kernel
def push(heap: Array, waiting: int, entry: tuple[float, ...]) -> int:
    """Put an entry into a binary heap [any, n] of entries of n numbers, with room for it; how many they are now."""
    hole = waiting
    for k in range(heap.shape[1]):
        heap[hole, k] = entry[k]
    while hole and _before(heap, hole, (hole - 1) // 2):
        _swap(heap, hole, (hole - 1) // 2)
        hole = (hole - 1) // 2
    return waiting + 1


@kernel
def pop(heap: Array, waiting: int) -> int:
    """Take the least entry, the first, out of a heap; how many they are now."""
    waiting -= 1
    _swap(heap, 0, waiting)
    hole, child = 0, 1
    while child < waiting:
        if child + 1 < waiting and _before(heap, child + 1, child):
            child += 1
        if not _before(heap, child, hole):
            break
        _swap(heap, child, hole)
        hole, child = child, 2 * child + 1
    return waiting


@kernel
def _before(heap: Array, a: int, b: int) -> bool:
    for k in range(heap.shape[1]):
        if heap[a, k] != heap[b, k]:
            return bool(heap[a, k] < heap[b, k])
    return False


@kernel
def _swap(heap: Array, a: int, b: int) -> None:
    for k in range(heap.shape[1]):
        heap[a, k], heap[b, k] = heap[b, k], heap[a, k]
