"""The inside of D* Lite's search, held against the definitions of the paper after every repair."""

from collections.abc import Callable
from itertools import count
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fogbench.planners.dstar_lite import DStarLite, DStarLiteAgent
from fogbench.planners.frontier import Frontier
from fogbench.planners.incremental import EMPTY, FAR, descend
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import manhattan
from fogbench.worlds.types import BLOCKED, DELTAS, FREE, UNKNOWN, Array, Cell

seeds = st.integers(0, 2**32 - 1)
both = pytest.mark.parametrize("planner", [DStarLite(), Frontier()])


def shifted(grid: Array, outside: int) -> Array:
    """What each cell's four neighbours hold, `outside` beyond the map: [4, H, W] int64."""
    padded = np.pad(grid.astype(np.int64), 1, constant_values=outside)  # [H + 2, W + 2]
    return np.stack([np.roll(padded, (-down, -right), (0, 1))[1:-1, 1:-1] for down, right in DELTAS])


def definition(agent: DStarLiteAgent, g: Array) -> Array:
    """Rhs by its definition: [H, W]."""
    known, goal = agent.known.cells, agent.goal
    exits = np.full(known.shape, FAR)
    if not agent.optimist:
        edge = (shifted(known, BLOCKED) == UNKNOWN).any(axis=0)
        exits[edge] = away(known, goal)[edge]
    exits[goal] = 0
    least = np.minimum(exits, shifted(g, FAR).min(axis=0) + 1)
    return np.where(known != BLOCKED if agent.optimist else known == FREE, np.minimum(least, FAR), FAR)


def away(grid: Array, place: Cell) -> Array:
    """Manhattan distances of all cells from one: [H, W]."""
    rows, columns = np.indices(grid.shape)  # [H, W] each
    return abs(rows - place[0]) + abs(columns - place[1])


def repaired(agent: DStarLiteAgent, g: Array, place: Cell) -> tuple[Array, int]:
    """What becomes of `g` where every key is always computed anew and there is no queue; and the cells expanded."""
    for expanded in count():
        rhs = definition(agent, g)
        k2 = np.minimum(g, rhs).astype(np.int64)  # [H, W]
        k1 = k2 + away(g, place)
        uneven = np.nonzero(g != rhs)
        top = min(zip(k1[uneven], k2[uneven], *uneven, strict=True), default=(2 * FAR,))
        if top[:2] >= (k1[place], k2[place]) and rhs[place] <= g[place]:
            return g, expanded
        u = top[2:]
        g[u] = rhs[u] if g[u] > rhs[u] else FAR
    raise AssertionError


def check_queue(agent: DStarLiteAgent) -> None:
    """U is a heap of exactly the inconsistent cells, `at` its inverse, and no key is above what it would be now."""
    entries = agent.queue[1 : agent.queue[0, 0] + 1].tolist()
    inside = {(row, column): at for at, (_, _, row, column) in enumerate(entries, start=1)}
    assert inside == {cell: int(agent.at[cell]) for cell in map(tuple, np.argwhere(agent.at).tolist())}
    assert set(inside) == set(map(tuple, np.argwhere(agent.g != agent.rhs).tolist()))
    for at, (k1, k2, *cell) in enumerate(entries, start=1):
        assert at == 1 or tuple(entries[at // 2 - 1][:2]) <= (k1, k2)
        assert k2 == min(agent.g[*cell], agent.rhs[*cell])
        assert k1 <= k2 + manhattan(tuple(cell), agent.last) + agent.k_m


def check_path(agent: DStarLiteAgent, place: Cell) -> None:
    """The greedy path loses 1 at each cell, all consistent after the first, until the goal or an exit."""
    while (move := descend(agent.g, agent.rhs, place)) >= 0:
        ahead = place[0] + DELTAS[move][0], place[1] + DELTAS[move][1]
        assert agent.g[ahead] == agent.rhs[ahead] == agent.rhs[place] - 1
        place = ahead
    exits = FAR if agent.optimist and place != agent.goal else manhattan(place, agent.goal)
    assert agent.rhs[place] in (exits, FAR)


@both
@given(seeds, st.sampled_from([0.0, 0.1, 0.3]), st.sampled_from([0.0, 0.3]))
@settings(max_examples=100)
def test_every_repair_is_exact(
    planner: Any, strew: Callable[..., GridWorld], explore: Callable[..., Any], seed: int, noise: float, slip: float
) -> None:
    """Under noise and slips, g, rhs and the number of expansions are those of the definitions; U and `at` agree."""
    rng = np.random.default_rng(seed)
    sensor = {"radius": int(rng.integers(1, 4)), "occlusion": bool(rng.integers(2)), "false_readings": noise}
    rules = {"collision": "blocked", "slip": slip, "slip_to": "sideways"}
    world = strew(rng, steps=30, sensor=sensor, rules=rules)
    g, before = np.full(world.blocked.shape, FAR), 0
    for agent, observation, _, _ in explore(planner, world, rng):
        g, expanded = repaired(agent, g, observation.place)
        assert np.array_equal(agent.g, g)
        assert np.array_equal(agent.rhs, definition(agent, g))
        closed = agent.rhs[observation.place] == FAR  # then the search of the view counts too
        assert closed or agent.search_nodes() - before == expanded
        before = agent.search_nodes()
        check_queue(agent)
        check_path(agent, observation.place)


@both
@given(seeds, st.booleans())
@settings(max_examples=200)
def test_every_goal_is_reached(
    planner: Any, strew: Callable[..., GridWorld], explore: Callable[..., Any], seed: int, occlusion: bool
) -> None:
    """Without noise, in a connected world and with steps to spare, the agent gets there and never collides."""
    rng = np.random.default_rng(seed)
    world = strew(rng, sensor={"radius": int(rng.integers(1, 4)), "occlusion": occlusion})
    *_, last = explore(planner, world, rng)
    assert last.step.reached


@both
def test_nothing_is_done_where_nothing_changes(
    planner: Any, draw: Callable[..., GridWorld], explore: Callable[..., Any]
) -> None:
    """Walking along the path over a map that is already known leaves every array, `last` and `k_m` as they were."""
    moments = explore(planner, draw("S....G ......", radius=9), np.random.default_rng(0))
    agent = next(moments).agent
    before = [agent.g.copy(), agent.rhs.copy(), agent.queue.copy(), agent.last, agent.k_m, agent.search_nodes()]
    assert len(list(moments)) == 4
    after = [agent.g, agent.rhs, agent.queue, agent.last, agent.k_m, agent.search_nodes()]
    assert all(np.array_equal(old, new) for old, new in zip(before, after, strict=True))


def test_the_queue_doubles_as_it_must_and_is_counted(
    draw: Callable[..., GridWorld], explore: Callable[..., Any]
) -> None:
    """In an open field of 100 x 100 it doubles once or twice, and all arrays count: 13 bytes a cell, 16 a row."""
    field = "\n".join(["S" + 99 * ".", *98 * [100 * "."], 99 * "." + "G"])
    agent = next(explore(DStarLite(), draw(field), np.random.default_rng(0))).agent
    assert len(agent.queue) in (2 * EMPTY, 4 * EMPTY)
    assert agent.memory_bytes() == 13 * 100 * 100 + 16 * len(agent.queue)
