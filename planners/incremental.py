"""D* Lite's search, the optimized version (Koenig & Likhachev 2002, figure 4; 2005, "Fast replanning for navigation").

The search runs from the goal to the agent and is repaired, not repeated, when the known map changes or the agent moves.
Every open cell `s` has edges of cost 1 to its four neighbours. A closed cell has no way out, rather than no way in: the
paths are the same, and a changed reading changes the edges of its own cell alone. Which cells are open, and what it
costs to leave the map straight to the goal, is the difference between two kinds of planner:

    optimist      a cell is open unless known to be blocked; only the goal has an exit, at cost 0
    not optimist  a cell is open once known to be free; beside an unknown cell, an exit costs the Manhattan distance

Words used here (the paper's)
    g, rhs  [H, W] int32, cost to the goal: as last expanded, and one step ahead from the neighbours' g; FAR is infinite
    key     `(k1, k2)`, compared in this order: k2 = min(g, rhs), k1 = k2 + h(start, s) + k_m
    k_m     how far the start has moved since the first key, so that older keys remain lower bounds
    U       [capacity, 4] int32, a binary heap of `(k1, k2, row, column)`, so that equal keys go in order of the map, in
            rows 1 and following; `U[0, 0]` is its length
    at      [H, W] int32, the row of a cell in U; 0: it is not there
"""
# ruff: noqa: N803, N806 (U is the name in the paper)

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.distances import FAR
from fogbench.worlds.types import BLOCKED, DELTAS, FREE, UNKNOWN, Array, Cell

EMPTY = 64  # rows of a new U
STAR = ((0, 0), *DELTAS)  # a cell and its neighbours

Key = tuple[int, int]
Entry = tuple[int, int, int, int]


@kernel
def replan(
    known: Array,
    g: Array,
    rhs: Array,
    U: Array,
    at: Array,
    goal: Cell,
    optimist: bool,
    touched: Array,
    start: Cell,
    last: Cell,
    k_m: int,
) -> tuple[Array, Cell, int, int]:
    """Repair the search for a start that may have moved and a map that may have changed (lines 36-48).

    Args:
        known: [H, W] uint8 of UNKNOWN, FREE, BLOCKED.
        g: updated in place, as are the next three; FAR everywhere before the first search.
        rhs: FAR everywhere at first.
        U: zeros at first.
        at: zeros at first.
        goal: a cell.
        optimist: which of the two kinds of planner it is.
        touched: [n] int32, flat indices (row * W + column) of the cells whose reading has changed.
        start: where the agent is.
        last: the start that `k_m` belongs to.
        k_m: 0 at first.

    Returns:
        `U`, moved where it has outgrown its array; `last` and `k_m`, new if any key was made; the cells expanded.
    """
    new_k_m = k_m + _h(last, start)
    changed = False
    for flat in touched:
        for down, right in STAR:
            s = (flat // g.shape[1] + down, flat % g.shape[1] + right)
            if not _inside(g, s):
                continue
            one_step = _look_ahead(known, g, goal, optimist, s)
            if one_step != rhs[s]:
                rhs[s] = one_step
                U = with_room(U, len(STAR))
                _update_vertex(g, rhs, U, at, start, new_k_m, s)
                changed = True
    if not changed and not _unfinished(g, rhs, U, start, new_k_m):
        return U, last, k_m, 0
    U, expanded = _compute_shortest_path(known, g, rhs, U, at, goal, optimist, start, new_k_m)
    return U, start, new_k_m, expanded


@kernel
def descend(g: Array, rhs: Array, start: Cell) -> int:
    """The first move of a shortest path after `replan` (line 34), ties in move order; -1 where there is none."""
    for move in range(4):
        s = (start[0] + DELTAS[move][0], start[1] + DELTAS[move][1])
        if _inside(g, s) and g[s] + 1 == rhs[start]:
            return move
    return -1


@kernel
def _compute_shortest_path(
    known: Array, g: Array, rhs: Array, U: Array, at: Array, goal: Cell, optimist: bool, start: Cell, k_m: int
) -> tuple[Array, int]:
    expanded = 0
    while _unfinished(g, rhs, U, start, k_m):
        U = with_room(U, len(STAR))
        top = entry_at(U, 1)
        k_old, u = top[:2], top[2:]
        k_new = _calculate_key(g, rhs, start, k_m, u)
        if k_old < k_new:
            settle(U, at, 1, (k_new[0], k_new[1], u[0], u[1]))
            continue
        expanded += 1
        if g[u] > rhs[u]:
            g[u] = rhs[u]
            remove(U, at, u)
            for down, right in DELTAS:
                s = (u[0] + down, u[1] + right)
                if _inside(g, s) and rhs[s] > g[u] + 1 and _open(known, optimist, s):
                    rhs[s] = g[u] + 1
                    _update_vertex(g, rhs, U, at, start, k_m, s)
        else:
            g_old = g[u]
            g[u] = FAR
            _update_vertex(g, rhs, U, at, start, k_m, u)
            for down, right in DELTAS:
                s = (u[0] + down, u[1] + right)
                if _inside(g, s) and rhs[s] == g_old + 1:
                    rhs[s] = _look_ahead(known, g, goal, optimist, s)
                    _update_vertex(g, rhs, U, at, start, k_m, s)
    return U, expanded


@kernel
def _unfinished(g: Array, rhs: Array, U: Array, start: Cell, k_m: int) -> bool:
    top_first = U[0, 0] and entry_at(U, 1)[:2] < _calculate_key(g, rhs, start, k_m, start)
    return bool(top_first or rhs[start] > g[start])


@kernel
def _look_ahead(known: Array, g: Array, goal: Cell, optimist: bool, s: Cell) -> int:
    """What rhs is by definition: the least of the exit's cost and, over the neighbours, 1 + g."""
    if not _open(known, optimist, s):
        return FAR
    if s == goal:
        return 0
    least = FAR
    for down, right in DELTAS:
        n = (s[0] + down, s[1] + right)
        if _inside(g, n):
            least = min(least, g[n] + 1)
            if not optimist and known[n] == UNKNOWN:
                least = min(least, _h(s, goal))
    return least


@kernel
def _open(known: Array, optimist: bool, s: Cell) -> bool:
    return bool(known[s] != BLOCKED if optimist else known[s] == FREE)


@kernel
def _inside(grid: Array, s: Cell) -> bool:
    return bool(0 <= s[0] < grid.shape[0] and 0 <= s[1] < grid.shape[1])


@kernel
def _h(a: Cell, b: Cell) -> int:
    return abs(a[0] - b[0]) + abs(a[1] - b[1])


@kernel
def _calculate_key(g: Array, rhs: Array, start: Cell, k_m: int, s: Cell) -> Key:
    k2 = min(g[s], rhs[s])
    return k2 + _h(start, s) + k_m, k2


@kernel
def _update_vertex(g: Array, rhs: Array, U: Array, at: Array, start: Cell, k_m: int, s: Cell) -> None:
    """Keep in U, under its present key, a cell whose g and rhs differ, and no other; U has room for one more."""
    if g[s] == rhs[s]:
        if at[s]:
            remove(U, at, s)
        return
    k1, k2 = _calculate_key(g, rhs, start, k_m, s)
    if not at[s]:
        U[0, 0] += 1
        at[s] = U[0, 0]
    settle(U, at, at[s], (k1, k2, s[0], s[1]))


@kernel
def remove(U: Array, at: Array, s: Cell) -> None:
    """Take a cell out of the heap."""
    hole, end = at[s], U[0, 0]
    at[s] = 0
    U[0, 0] = end - 1
    if hole < end:
        settle(U, at, hole, entry_at(U, end))


@kernel
def settle(U: Array, at: Array, hole: int, entry: Entry) -> None:
    """Lay an entry where it belongs in the heap, given a row that is free for it or for those it displaces."""
    while hole > 1 and entry < entry_at(U, hole // 2):
        _move(U, at, hole // 2, hole)
        hole //= 2
    child = 2 * hole
    while child <= U[0, 0]:
        if child < U[0, 0] and entry_at(U, child + 1) < entry_at(U, child):
            child += 1
        if entry < entry_at(U, child):
            break
        _move(U, at, child, hole)
        hole, child = child, 2 * child
    U[hole, 0], U[hole, 1], U[hole, 2], U[hole, 3] = entry
    at[entry[2], entry[3]] = hole


@kernel
def entry_at(U: Array, row: int) -> Entry:
    """What stands in a row of the heap."""
    return int(U[row, 0]), int(U[row, 1]), int(U[row, 2]), int(U[row, 3])  # one type of key, compiled once


@kernel
def _move(U: Array, at: Array, row: int, hole: int) -> None:
    for k in range(4):
        U[hole, k] = U[row, k]
    at[U[row, 2], U[row, 3]] = hole


@kernel
def with_room(U: Array, entries: int) -> Array:
    """U itself, or one twice as large, so that as many cells can enter; EMPTY at most."""
    if U[0, 0] + entries < len(U):
        return U
    return np.concatenate((U, np.zeros_like(U)))  # [2 * capacity, 4]
