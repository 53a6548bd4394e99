"""A* and D* Lite over eight neighbours, against an independent search and against each other."""

from itertools import pairwise
from math import inf
from typing import Any

import networkx as nx
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fogbench.planners.incremental import EMPTY
from fogbench.planners.robot.incremental import descent, replan
from fogbench.planners.robot.prices import OPEN, TIGHT, prices_of
from fogbench.planners.robot.search import cut, nearest, search
from fogbench.worlds.robot.gaps import gaps, keep_up, rings
from fogbench.worlds.robot.known import reach
from fogbench.worlds.robot.octile import FAR, STEPS
from fogbench.worlds.robot.rules import Body, Lidar, Outfit
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array, Cell

SEEDS = st.integers(0, 2**32 - 1)
OUTFIT = Outfit(Lidar(), Body(), 0.2, 0.3)
PRICES = prices_of(OUTFIT)
RINGS = rings(reach(OUTFIT))


def strewn(rng: np.random.Generator, share: float = 0.04) -> tuple[Array, Array]:
    """A map of a few cells of 20 cm, and its gaps."""
    height, width = rng.integers(8, 20, 2)
    cells = np.where(rng.random((height, width)) < share, BLOCKED, FREE).astype(np.uint8)
    return cells, gaps(cells, RINGS)


def roomy(rng: np.random.Generator, gap: Array) -> Cell:
    """A cell in which the body has room, or any if it has none."""
    found = np.argwhere(PRICES[gap] > 0)
    row, column = found[rng.integers(len(found))].tolist() if len(found) else (0, 0)
    return row, column


def cost(gap: Array, path: Array, *, leaving: bool) -> float:
    """What a path costs, at the prices of the cells that it leaves or enters; infinite for none."""
    cells = [divmod(int(flat), gap.shape[1]) for flat in path]
    lengths = {(down, right): length for down, right, length in STEPS}
    steps = [(a, b, lengths[b[0] - a[0], b[1] - a[1]]) for a, b in pairwise(cells)]
    return float(sum(length * PRICES[gap[a if leaving else b]] for a, b, length in steps)) if len(path) else inf


def cheapest(gap: Array, start: Cell, goal: Cell, *, leaving: bool) -> float:
    """The same of a cheapest path, by networkx."""
    graph: Any = nx.DiGraph()
    graph.add_nodes_from([start, goal])
    for a in np.ndindex(*gap.shape):
        for down, right, length in STEPS:
            b = (a[0] + down, a[1] + right)
            if 0 <= b[0] < gap.shape[0] and 0 <= b[1] < gap.shape[1]:
                price = int(PRICES[gap[a if leaving else b]])
                if price:
                    graph.add_edge(a, b, weight=length * price)
    try:
        return float(nx.dijkstra_path_length(graph, start, goal))
    except nx.NetworkXNoPath:
        return inf


def test_prices_grow_near_walls() -> None:
    """Nothing fits at a wall; then it is tight, and the farther away, the cheaper."""
    assert PRICES[0] == 0
    paid = PRICES[PRICES > 0]
    assert (np.diff(paid) <= 0).all()
    assert paid[0] == TIGHT
    assert paid[-1] == OPEN


@settings(max_examples=60)
@given(seed=SEEDS)
def test_a_star_is_cheapest_within_half_a_percent(seed: int) -> None:
    """And finds a path wherever there is one."""
    rng = np.random.default_rng(seed)
    cells, gap = strewn(rng)
    start, goal = roomy(rng, gap), roomy(rng, gap)
    path, expanded = search(cells, gap, PRICES, 0, start, goal, True)
    best = cheapest(gap, start, goal, leaving=False)
    found = cost(gap, path, leaving=False)
    assert found == best == inf or best <= found <= 1.005 * best + 1e-9
    assert expanded >= len(path) > 0 or found == inf


@settings(max_examples=60)
@given(seed=SEEDS)
def test_d_star_lite_stays_cheapest(seed: int) -> None:
    """While walls come and go and the robot moves."""
    rng = np.random.default_rng(seed)
    cells, gap = strewn(rng)
    goal = roomy(rng, gap)
    g, rhs, at = (np.full(gap.shape, FAR, np.int32) for _ in range(3))
    at[:], queue, last, k_m = 0, np.zeros((EMPTY, 4), np.int32), goal, 0
    touched = np.array([goal[0] * gap.shape[1] + goal[1]])
    for _ in range(5):
        start = roomy(rng, gap)
        queue, last, k_m, _ = replan(gap, PRICES, g, rhs, queue, at, goal, touched, start, last, k_m)
        path = descent(gap, PRICES, g, start, goal)
        assert cost(gap, path, leaving=True) == cheapest(gap, start, goal, leaving=True)
        changed = rng.choice(cells.size, 3, replace=False)
        changed = changed[changed != goal[0] * gap.shape[1] + goal[1]]
        cells.flat[changed] = FREE + BLOCKED - cells.flat[changed]
        touched = keep_up(cells, gap, RINGS, changed)


def test_who_is_no_optimist_stops_at_the_edge() -> None:
    """Of what is known, on the way to the goal."""
    cells = np.full((9, 20), UNKNOWN, np.uint8)
    cells[:, :8] = FREE
    path, _ = search(cells, gaps(cells, RINGS), PRICES, 0, (4, 3), (4, 16), False)
    assert path.tolist() == [4 * 20 + column for column in range(3, 8)]


def test_a_start_beside_a_wall_is_left_through_its_zone() -> None:
    """Where the body has no room, cells count that have as much as the start, but no wall."""
    cells = np.full((9, 20), FREE, np.uint8)
    cells[4, 3] = BLOCKED
    outfit = OUTFIT._replace(cell=0.1)
    gap, prices = gaps(cells, rings(reach(outfit))), prices_of(outfit)
    assert prices[gap[4, 5]] == 0
    assert len(search(cells, gap, prices, 3, (4, 4), (4, 16), True)[0])
    assert not len(search(cells, gap, prices, 0, (4, 4), (4, 16), True)[0])


def test_a_path_is_followed_and_cut() -> None:
    """The place on it that is nearest to a point; and a wall that came to stand beside what is left of it."""
    cells = np.full((9, 20), FREE, np.uint8)
    gap = gaps(cells, RINGS)
    path = np.arange(4 * 20 + 3, 4 * 20 + 17, dtype=np.int32)
    at, far = nearest(path, 0, 7.5, 5.5, 20, 60)
    assert (at, far) == (4, 1.0)
    assert not cut(gap, PRICES, 0, path, at, (4, 16))
    cells[4, 5] = BLOCKED
    keep_up(cells, gap, RINGS, np.array([4 * 20 + 5]))
    assert cut(gap, PRICES, 0, path, 0, (4, 16))
    assert not cut(gap, PRICES, 0, path, 5, (4, 16))
