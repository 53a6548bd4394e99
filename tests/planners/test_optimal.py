"""Optimal moves on known maps, held against all shortest paths that networkx finds."""

from collections.abc import Callable
from typing import Any

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fogbench.planners.optimal import OptimalMoves
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.types import BLOCKED, DELTAS, FREE, Array, Cell, Move

MAPS = Blobs(size=8, obstacles=(3, 9), obstacle_size=(1, 3))
NOISE = {"false_readings": 0.1, "slip": 0.2, "collision": "blocked"}


def best(known: Array, place: Cell, goal: Cell) -> set[int]:
    """The moves that begin a shortest path, by networkx; none where there is no path or none is needed."""
    graph = nx.grid_2d_graph(*known.shape)
    graph.remove_nodes_from({tuple(cell) for cell in np.argwhere(known == BLOCKED).tolist()} - {place})
    if place == goal or goal not in graph or not nx.has_path(graph, place, goal):
        return set()
    ahead = {path[1] for path in nx.all_shortest_paths(graph, place, goal)}
    return {move for move, (down, right) in enumerate(DELTAS) if (place[0] + down, place[1] + right) in ahead}


@pytest.mark.parametrize("fields", [{}, NOISE], ids=["exact", "noisy"])
def test_moves_are_those_of_all_shortest_paths(conditions: Callable[..., Any], fields: dict[str, Any]) -> None:
    """On a random walk's known map, after every look, whatever was kept from the decisions before."""
    several = undefined = 0
    for seed in range(8):
        rng = np.random.default_rng(seed)
        world = MAPS.sample(rng, 0, conditions(steps=30, distance=(4, 20), **{"collision": "blocked", **fields}))
        known, state = KnownMap(world.task.extent), world.reset()
        optimal = OptimalMoves(world.task.goal, known.cells)
        for _ in range(30):
            observation = world.sense(state, rng)
            optimal.see(known.update(observation))
            moves = optimal.moves(observation.place)
            assert set(np.flatnonzero(moves).tolist()) == best(known.cells, observation.place, world.task.goal)
            several, undefined = several + (moves.sum() > 1), undefined + (not moves.any())
            state = world.step(state, Move(rng.integers(4)), rng).state
    assert several > 20
    assert undefined > 0


def test_around_a_wall_that_is_seen(draw: Callable[..., GridWorld]) -> None:
    """Before a wall in view the moves along it are optimal, not the one into it; at the goal none is needed."""
    world = draw("...\nS#G\n...")
    known = KnownMap(world.task.extent)
    optimal = OptimalMoves(world.task.goal, known.cells)
    optimal.see(known.update(world.sense(world.reset(), np.random.default_rng(0))))
    assert optimal.moves(world.start).tolist() == [True, False, True, False]
    assert not optimal.moves(world.task.goal).any()


@given(seed=st.integers(0, 2**32 - 1))
def test_kept_distances_are_those_of_a_new_search(seed: int) -> None:
    """Whatever readings change, anywhere and back again, the moves are those of a search from nothing."""
    rng = np.random.default_rng(seed)
    known = np.zeros((6, 7), np.uint8)
    optimal, goal = OptimalMoves((5, 6), known), (5, 6)
    for _ in range(30):
        seen = np.unique(rng.integers(known.size, size=5))
        readings = rng.choice(np.array([FREE, FREE, BLOCKED], np.uint8), size=len(seen))
        touched = seen[known.flat[seen] != readings]
        known.flat[seen] = readings
        optimal.see(touched.astype(np.int32))
        place = tuple(np.argwhere(known != BLOCKED)[rng.integers((known != BLOCKED).sum())].tolist())
        assert optimal.moves(place).tolist() == OptimalMoves(goal, known).moves(place).tolist()
