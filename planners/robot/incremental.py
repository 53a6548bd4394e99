"""D* Lite over the eight neighbours of cells, each at its price (Koenig & Likhachev 2002, figure 4).

The letters are those of `fogbench.planners.incremental`, whose heap it uses. What it costs to leave a cell is the
length of the step times the price of that cell, so that a changed price changes the edges of its own cell alone; a cell
without room has no way out.
"""
# ruff: noqa: N803, N806 (U is the name in the paper)

import numpy as np

from fogbench.planners.incremental import Key, entry_at, remove, settle, with_room
from fogbench.planners.robot.prices import OPEN
from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.octile import FAR, STEPS, octile
from fogbench.worlds.types import Array, Cell


@kernel
def replan(
    gap: Array, prices: Array, g: Array, rhs: Array, U: Array, at: Array,
    goal: Cell, touched: Array, start: Cell, last: Cell, k_m: int,
) -> tuple[Array, Cell, int, int]:  # fmt: skip
    """Repair the search for a start that may have moved and prices that may have changed (lines 36-48).

    Args:
        gap: [H, W] uint16.
        prices: [n] int32, by gap.
        g: updated in place, as are the next three; FAR everywhere before the first search.
        rhs: FAR everywhere at first, but 0 at the goal, which is in U then.
        U: zeros at first.
        at: zeros at first.
        goal: a cell.
        touched: [n] int64, flat indices of the cells whose gap has changed.
        start: where the robot is.
        last: the start that `k_m` belongs to.
        k_m: 0 at first.

    Returns:
        `U`, moved where it has outgrown its array; `last` and `k_m` of now; the cells expanded.
    """
    k_m += _h(last, start)
    for flat in touched:
        s = (flat // g.shape[1], flat % g.shape[1])
        one_step = _look_ahead(gap, prices, g, goal, s)
        if one_step != rhs[s]:
            rhs[s] = one_step
            U = with_room(U, 1)
            _update_vertex(g, rhs, U, at, start, k_m, s)
    U, expanded = _compute_shortest_path(gap, prices, g, rhs, U, at, goal, start, k_m)
    return U, start, k_m, expanded


@kernel
def descent(gap: Array, prices: Array, g: Array, start: Cell, goal: Cell) -> Array:
    """The cells of a cheapest path after `replan`, both ends among them: [n] int32; empty where there is none."""
    height, width = g.shape
    path, s = [start[0] * width + start[1]], start
    while s != goal and len(path) < g.size:
        price, least, best = prices[gap[s]], FAR, s
        for down, right, cost in STEPS:
            n = (s[0] + down, s[1] + right)
            if price and 0 <= n[0] < height and 0 <= n[1] < width and g[n] < FAR and g[n] + cost * price < least:
                least, best = g[n] + cost * price, n
        if best == s:
            return np.empty(0, np.int32)
        s = best
        path.append(s[0] * width + s[1])
    return np.array(path, np.int32)


@kernel
def _compute_shortest_path(
    gap: Array, prices: Array, g: Array, rhs: Array, U: Array, at: Array, goal: Cell, start: Cell, k_m: int
) -> tuple[Array, int]:
    height, width = g.shape
    expanded = 0
    while _unfinished(g, rhs, U, start, k_m):
        U = with_room(U, len(STEPS) + 1)
        top = entry_at(U, 1)
        k_old, u = top[:2], top[2:]
        k_new = _calculate_key(g, rhs, start, k_m, u)
        if k_old < k_new:
            settle(U, at, 1, (k_new[0], k_new[1], u[0], u[1]))
            continue
        expanded += 1
        g_old, lowered = g[u], g[u] > rhs[u]
        if lowered:
            g[u] = rhs[u]
            remove(U, at, u)
        else:
            g[u] = FAR
            _update_vertex(g, rhs, U, at, start, k_m, u)
        for down, right, cost in STEPS:
            s = (u[0] + down, u[1] + right)
            if not (0 <= s[0] < height and 0 <= s[1] < width) or s == goal or prices[gap[s]] == 0:
                continue
            leave = cost * prices[gap[s]]
            if lowered and rhs[s] > g[u] + leave:
                rhs[s] = g[u] + leave
            elif not lowered and rhs[s] == g_old + leave:
                rhs[s] = _look_ahead(gap, prices, g, goal, s)
            else:
                continue
            _update_vertex(g, rhs, U, at, start, k_m, s)
    return U, expanded


@kernel
def _unfinished(g: Array, rhs: Array, U: Array, start: Cell, k_m: int) -> bool:
    top_first = U[0, 0] and entry_at(U, 1)[:2] < _calculate_key(g, rhs, start, k_m, start)
    return bool(top_first or rhs[start] > g[start])


@kernel
def _look_ahead(gap: Array, prices: Array, g: Array, goal: Cell, s: Cell) -> int:
    """What rhs is by definition: over the neighbours the least of what the step costs, and their g."""
    if s == goal:
        return 0
    price, least = int(prices[gap[s]]), FAR
    for down, right, cost in STEPS:
        n = (s[0] + down, s[1] + right)
        if price and 0 <= n[0] < g.shape[0] and 0 <= n[1] < g.shape[1] and g[n] < FAR:
            least = min(least, g[n] + cost * price)
    return least


@kernel
def _h(a: Cell, b: Cell) -> int:
    return OPEN * octile(a[0] - b[0], a[1] - b[1])


@kernel
def _calculate_key(g: Array, rhs: Array, start: Cell, k_m: int, s: Cell) -> Key:
    k2 = int(min(g[s], rhs[s]))
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
