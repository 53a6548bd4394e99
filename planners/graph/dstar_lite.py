"""D* Lite on the graph seen so far: the ways of A*, by repairing the last search (Koenig & Likhachev 2002, figure 4).

Words used here (the paper's)
    g, rhs  [N] float64, length to the goal: as last expanded, and one step ahead from the neighbours' g
    key     `(k1, k2)`, compared in this order: k2 = min(g, rhs), k1 = k2 + h(start, s) + k_m
    k_m     how far the start has moved since the first key, so that older keys remain lower bounds
    U       [capacity, 3], a heap of `(k1, k2, node)` in rows 0 and following; an entry counts as long as it is the
            node's own key
    keys    [N, 2], of the nodes in U; infinite for the others

At a node that was seen and not visited, an edge straight to the goal is supposed, as A* does.
"""
# ruff: noqa: N803, N806 (U is the name in the paper)

import numpy as np

from fogbench.planners.graph.agent import GraphAgent
from fogbench.planners.graph.astar import SHORT, exit_of, straight
from fogbench.worlds.graph.distances import pop, push
from fogbench.worlds.graph.known import NONE
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array, Observation, Task

EMPTY = 64
"""Rows of a new U."""


class GraphDStarLiteAgent(GraphAgent):
    """One episode of incremental search."""

    def __init__(self, task: Task) -> None:
        """Plan towards the task's goal."""
        super().__init__(task)
        size = len(self.known.heads)
        self.g, self.rhs, self.keys = np.full(size, np.inf), np.full(size, np.inf), np.full((size, 2), np.inf)
        self.queue, self.waiting = np.empty((EMPTY, 3)), 0
        self.last, self.k_m = -1, 0.0

    def step(self, observation: Observation, *, fresh: bool) -> tuple[int, int]:
        """The way of A*."""
        place = observation.place
        if self.last < 0:
            self.last = place
        known = *self.known.arrays, self.known.coordinates
        self.queue, self.waiting, self.k_m, expanded = replan(
            *known, self.g, self.rhs, self.keys, self.queue, self.waiting, self.goal, place, self.last, self.k_m, fresh
        )
        self.last = place
        return descend(self.known.heads, self.known.links, self.known.lengths, self.g, place, self.goal), expanded

    def memory_bytes(self) -> int:
        """The known graph, the costs and the queue."""
        return super().memory_bytes() + sum(array.nbytes for array in (self.g, self.rhs, self.keys, self.queue))


@kernel
def replan(
    visited: Array, heads: Array, links: Array, lengths: Array, coordinates: Array, g: Array, rhs: Array, keys: Array,
    U: Array, waiting: int, goal: int, start: int, last: int, k_m: float, fresh: bool,
) -> tuple[Array, int, float, int]:  # fmt: skip
    """Repair the search for a start that may have moved, and may be `fresh`: its edges were not known before.

    Returns:
        `U`, moved where it has outgrown its array; how many entries it has; `k_m`; the nodes expanded.
    """
    known = visited, heads, links, lengths, coordinates
    k_m += SHORT * straight(coordinates, last, start)
    if fresh:
        U, waiting = _see(known, g, rhs, keys, U, waiting, goal, start, k_m, start)
        U, waiting = _see_around(known, g, rhs, keys, U, waiting, goal, start, k_m, start)
    expanded = 0
    while waiting:
        k1, k2, u = U[0, 0], U[0, 1], int(U[0, 2])
        if k1 != keys[u, 0] or k2 != keys[u, 1]:
            waiting = pop(U, waiting)
            continue
        if (k1, k2) >= _key(coordinates, g, rhs, start, k_m, start) and rhs[start] <= g[start]:
            break
        waiting = pop(U, waiting)
        keys[u] = np.inf
        if (k1, k2) < _key(coordinates, g, rhs, start, k_m, u):
            U, waiting = _update_vertex(coordinates, g, rhs, keys, U, waiting, start, k_m, u)
            continue
        expanded += 1
        raised = g[u] <= rhs[u]
        g[u] = np.inf if raised else rhs[u]
        if raised:
            U, waiting = _see(known, g, rhs, keys, U, waiting, goal, start, k_m, u)
        U, waiting = _see_around(known, g, rhs, keys, U, waiting, goal, start, k_m, u)
    return U, waiting, k_m, expanded


@kernel
def descend(heads: Array, links: Array, lengths: Array, g: Array, start: int, goal: int) -> int:
    """The neighbour that begins a shortest way after `replan`; NONE where there is none.

    Of several it is the goal, whose edge is there while others are supposed, or else the least number.
    """
    best, length, link = NONE, np.inf, heads[start]
    while link != NONE:
        other, through = links[link, 1], lengths[link] + g[links[link, 1]]
        if through < length or (through == length < np.inf and best != goal and (other == goal or other < best)):
            best, length = other, through
        link = links[link, 0]
    return best


@kernel
def _see(
    known: tuple[Array, Array, Array, Array, Array], g: Array, rhs: Array, keys: Array, U: Array, waiting: int,
    goal: int, start: int, k_m: float, s: int,
) -> tuple[Array, int]:  # fmt: skip
    """Look one step ahead from a node."""
    visited, heads, links, lengths, coordinates = known
    least = 0.0 if s == goal else exit_of(visited, heads, coordinates, s, goal)
    link = heads[s]
    while link != NONE:
        least = min(least, lengths[link] + g[links[link, 1]])
        link = links[link, 0]
    rhs[s] = least
    return _update_vertex(coordinates, g, rhs, keys, U, waiting, start, k_m, s)


@kernel
def _see_around(
    known: tuple[Array, Array, Array, Array, Array], g: Array, rhs: Array, keys: Array, U: Array, waiting: int,
    goal: int, start: int, k_m: float, s: int,
) -> tuple[Array, int]:  # fmt: skip
    """Look one step ahead from all neighbours of a node."""
    link = known[1][s]
    while link != NONE:
        U, waiting = _see(known, g, rhs, keys, U, waiting, goal, start, k_m, known[2][link, 1])
        link = known[2][link, 0]
    return U, waiting


@kernel
def _key(coordinates: Array, g: Array, rhs: Array, start: int, k_m: float, s: int) -> tuple[float, float]:
    k2 = min(g[s], rhs[s])
    return k2 + SHORT * straight(coordinates, start, s) + k_m, k2


@kernel
def _update_vertex(
    coordinates: Array, g: Array, rhs: Array, keys: Array, U: Array, waiting: int, start: int, k_m: float, s: int
) -> tuple[Array, int]:  # fmt: skip
    """Keep in U, under its present key, a node whose g and rhs differ, and no other."""
    if g[s] == rhs[s]:
        keys[s] = np.inf
        return U, waiting
    k1, k2 = _key(coordinates, g, rhs, start, k_m, s)
    if keys[s, 0] == k1 and keys[s, 1] == k2:
        return U, waiting
    keys[s, 0], keys[s, 1] = k1, k2
    if waiting == len(U):
        U = np.concatenate((U, np.empty_like(U)))
    return U, push(U, waiting, (k1, k2, float(s)))
