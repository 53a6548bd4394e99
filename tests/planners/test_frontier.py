"""Frontier exploration, held against networkx."""

from collections.abc import Callable
from typing import Any

import networkx as nx
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fogbench.planners.frontier import Frontier
from fogbench.planners.incremental import FAR
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import manhattan
from fogbench.worlds.types import FREE, UNKNOWN, Array, Cell, Move

seeds = st.integers(0, 2**32 - 1)


def least(known: Array, place: Cell, goal: Cell) -> int:
    """The least path cost plus distance to the goal over reachable frontier cells and a known goal; FAR without any."""
    whole = nx.grid_2d_graph(*known.shape)
    free = whole.subgraph([cell for cell in whole if known[cell] == FREE])
    targets = {cell for cell in free if cell == goal or any(known[near] == UNKNOWN for near in whole[cell])}
    paths = nx.single_source_shortest_path_length(free, place)
    return min((length + manhattan(cell, goal) for cell, length in paths.items() if cell in targets), default=FAR)


@given(seeds, st.sampled_from([0.0, 0.1, 0.3]), st.sampled_from([0.0, 0.3]))
@settings(max_examples=300)
def test_it_walks_towards_the_least_sum(
    strew: Callable[..., GridWorld], explore: Callable[..., Any], seed: int, noise: float, slip: float
) -> None:
    """At every step its target has the least sum, and its move is one less away from it, over a known free cell."""
    rng = np.random.default_rng(seed)
    sensor = {"radius": int(rng.integers(1, 4)), "occlusion": bool(rng.integers(2)), "false_readings": noise}
    rules = {"collision": "blocked", "slip": slip, "slip_to": "sideways"}
    world = strew(rng, steps=40, sensor=sensor, rules=rules)
    for agent, observation, action, _ in explore(Frontier(), world, rng):
        known, place, goal = agent.known.cells, observation.place, world.task.goal
        found = least(known, place, goal)
        assert agent.rhs[place] == found
        if found < FAR:
            ahead = place[0] + action.delta[0], place[1] + action.delta[1]
            assert known[ahead] == FREE
            assert least(known, ahead, goal) == found - 1


def test_it_weighs_the_way_against_what_is_left(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """By hand: at radius 1 both neighbours in the corridor are frontier cells, and the right one is 2 nearer."""
    moments = explore(Frontier(), draw("...S....G"), np.random.default_rng(0))
    seen = [(moment.action, int(moment.agent.rhs[moment.observation.place])) for moment in moments]
    assert seen == [(Move.RIGHT, cost) for cost in (5, 4, 3, 2, 1)]


def test_it_turns_back_from_a_dead_end(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """By hand: one step right it sees the corridor's end; the frontier cell left is 2 behind and 4 from the goal."""
    moments = explore(Frontier(), draw("..S.#G .###.. ......"), np.random.default_rng(0))
    seen = [(moment.action, int(moment.agent.rhs[moment.observation.place])) for moment in moments]
    right, down, left, up = Move.RIGHT, Move.DOWN, Move.LEFT, Move.UP
    assert [move for move, _ in seen] == [right, left, left, left, down, down, *[right] * 5, up, up]
    assert seen[:2] == [(right, 3), (left, 6)]


def test_without_a_frontier_it_plans_on_the_current_view(misled: Callable[..., Any]) -> None:
    """First the corridor's unknown end behind it is the frontier; with that seen too, only the view is left."""
    actions, _ = misled(Frontier())
    assert actions == [Move.LEFT, Move.RIGHT]
