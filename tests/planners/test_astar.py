"""A*, held against networkx and against a plain heap."""

from collections.abc import Callable
from heapq import heappop, heappush
from itertools import count
from typing import Any

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fogbench.planners.astar import AStar, search
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import manhattan
from fogbench.worlds.types import BLOCKED, DELTAS, Array, Cell, Move

seeds = st.integers(0, 2**32 - 1)


def draw_known(seed: int) -> tuple[Array, Cell, Cell]:
    """A known map of all three values, 1 x 1 to 14 x 14, and two of its cells; the goal may be blocked."""
    rng = np.random.default_rng(seed)
    shape = rng.integers(1, 15, size=2)
    blocked = rng.uniform(0, 0.6)
    known = rng.choice(3, size=shape, p=[(1 - blocked) / 2, (1 - blocked) / 2, blocked]).astype(np.uint8)  # [H, W]
    start, goal = (tuple(rng.integers(shape).tolist()) for _ in range(2))
    return known, start, goal


def graph_of(known: Array, start: Cell) -> nx.Graph:
    """The cells that are not known to be blocked, and the start."""
    graph = nx.grid_2d_graph(*known.shape)
    graph.remove_nodes_from([cell for cell in map(tuple, np.argwhere(known == BLOCKED).tolist()) if cell != start])
    return graph


def length(known: Array, start: Cell, goal: Cell) -> int | None:
    """Cells from start to goal by networkx; None where there is no path."""
    graph = graph_of(known, start)
    return nx.shortest_path_length(graph, start, goal) if goal in graph and nx.has_path(graph, start, goal) else None


def plain(known: Array, start: Cell, goal: Cell) -> tuple[list[Cell], int]:
    """A* as a textbook has it: a heap of `(f, -g, order of generation)`; the path and the expanded cells."""
    order, g, parent, closed = count(), {start: 0}, {start: start}, set()
    heap = [(manhattan(start, goal), 0, next(order), start)]
    while heap:
        cell = heappop(heap)[-1]
        if cell in closed:
            continue
        closed.add(cell)
        if cell == goal:
            path = [goal]
            while path[0] != start:
                path.insert(0, parent[path[0]])
            return path, len(closed)
        for down, right in DELTAS:
            near = cell[0] + down, cell[1] + right
            inside = 0 <= near[0] < known.shape[0] and 0 <= near[1] < known.shape[1]
            if inside and known[near] != BLOCKED and g[cell] + 1 < g.get(near, np.inf):
                g[near], parent[near] = g[cell] + 1, cell
                heappush(heap, (g[near] + manhattan(near, goal), -g[near], next(order), near))
    return [], len(closed)


@given(seeds)
@settings(max_examples=500)
def test_the_path_is_as_short_as_that_of_networkx(seed: int) -> None:
    """The path is connected, open, and of the least length; it is empty exactly where there is none."""
    known, start, goal = draw_known(seed)
    path = [divmod(cell, known.shape[1]) for cell in search(known, start, goal)[0].tolist()]
    assert (len(path) - 1 if path else None) == length(known, start, goal)
    if path:
        assert (path[0], path[-1]) == (start, goal)
        assert nx.is_path(graph_of(known, start), path)


@given(seeds)
@settings(max_examples=500)
def test_the_order_is_exactly_that_of_a_heap(seed: int) -> None:
    """Path and number of expansions are those of a heap of `(f, -g, order of generation)`."""
    known, start, goal = draw_known(seed)
    path, expanded = search(known, start, goal)
    assert ([divmod(cell, known.shape[1]) for cell in path.tolist()], expanded) == plain(known, start, goal)


@pytest.mark.parametrize("replan", ["cut", "change"])
@given(seeds, st.booleans())
@settings(max_examples=100)
def test_every_move_starts_a_shortest_path_on_the_known_map(
    replan: Any, strew: Callable[..., GridWorld], explore: Callable[..., Any], seed: int, occlusion: bool
) -> None:
    """Without noise a path that was not cut stays a shortest one, and every agent reaches the goal."""
    rng = np.random.default_rng(seed)
    world = strew(rng, sensor={"radius": int(rng.integers(1, 4)), "occlusion": occlusion})
    for moment in explore(AStar(replan=replan), world, rng):
        known, place, (down, right) = moment.agent.known.cells, moment.observation.place, moment.action.delta
        left = length(known, (place[0] + down, place[1] + right), world.task.goal)
        assert left is not None
        assert left + 1 == length(known, place, world.task.goal)
    assert moment.step.reached


@pytest.mark.parametrize(("replan", "expanded"), [("cut", [6, 6, 6, 6, 6]), ("change", [6, 11, 15, 18, 20])])
def test_a_path_is_kept_until_it_is_cut(
    replan: Any, expanded: list[int], draw: Callable[..., GridWorld], explore: Callable[..., Any]
) -> None:
    """An obstacle beside the path makes only the eager agent plan again, as do new free cells: 6, 5, 4, 3, 2 cells."""
    moments = explore(AStar(replan=replan), draw("S....G ..#..."), np.random.default_rng(0))
    seen = [(moment.action, moment.agent.search_nodes()) for moment in moments]
    assert seen == [(Move.RIGHT, cells) for cells in expanded]


def test_a_cut_makes_it_plan_again(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """A wall across the path is met one cell ahead, and walked round by the first of two equal ways, downwards."""
    moments = list(explore(AStar(), draw("..... S..#G ....."), np.random.default_rng(0)))
    actions = [moment.action for moment in moments]
    assert actions == [Move.RIGHT, Move.RIGHT, Move.DOWN, Move.RIGHT, Move.RIGHT, Move.UP]


def test_a_closed_map_leaves_the_current_view(misled: Callable[..., Any]) -> None:
    """Each time the search of the known map expands 3 cells in vain, then that of the view 3 more."""
    assert misled(AStar()) == ([None, Move.RIGHT], [6, 12])


def test_memory_is_the_known_map_and_the_path(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """A map of 6 cells at 1 byte and a path of 6 cells at 4."""
    moment = next(explore(AStar(), draw("S....G"), np.random.default_rng(0)))
    assert moment.agent.memory_bytes() == 6 + 4 * 6
