"""OMPL's planners over the known map."""

import json
import math
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from itertools import combinations, pairwise
from typing import Any, get_args

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fogbench.planners import rrt_star
from fogbench.planners.astar import search
from fogbench.planners.rrt_star import Plan, RrtStar, plan
from fogbench.planners.segment import PARTS, clear
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.types import BLOCKED, Array, Cell, Move

PLANNERS = get_args(RrtStar.model_fields["planner"].annotation)

seeds = st.integers(0, 2**32 - 1)

WALL = np.array(
    [
        [0, 0, 0, 0, 0, 0, 0, 0],
        [0, 0, 0, 2, 0, 0, 0, 0],
        [0, 0, 0, 2, 0, 0, 0, 0],
        [0, 0, 0, 2, 0, 0, 0, 0],
        [0, 0, 0, 2, 2, 2, 0, 0],
        [0, 0, 0, 0, 0, 0, 0, 0],
    ],
    np.uint8,
)
"""A known map with a way round a wall from START to GOAL."""
START, GOAL = (3, 1), (3, 5)


def words(found: Plan) -> list[Any]:
    """A plan, as JSON would read it back."""
    return [found.states.tolist(), found.cells.tolist(), found.vertices, found.exact]


def plans() -> dict[str, list[Any]]:
    """A plan of each planner."""
    return {name: words(plan(WALL, START, GOAL, RrtStar(planner=name), 7)) for name in PLANNERS}


def strewn(seed: int, density: float = 0.2) -> tuple[Array, Cell, Cell]:
    """A known map of 8 x 8 cells with a way from one cell to another."""
    rng = np.random.default_rng(seed)
    while True:
        known = np.where(rng.random((8, 8)) < density, BLOCKED, 0).astype(np.uint8)
        ends = [divmod(int(cell), 8) for cell in rng.choice(np.flatnonzero(known != BLOCKED), 2, replace=False)]
        if len(search(known, *ends)[0]):
            return known, ends[0], ends[1]


def crosses(a: Array, b: Array, cell: Array) -> bool:
    """Whether a motion between points in half cells has a point inside a cell, borders left out."""
    enter, leave = Fraction(0), Fraction(1)
    for start, end, centre in zip(a.tolist(), b.tolist(), (2 * cell).tolist(), strict=True):
        if start == end:
            if not centre - 1 < start < centre + 1:
                return False
            continue
        first, last = sorted(Fraction(side - start, end - start) for side in (centre - 1, centre + 1))
        enter, leave = max(enter, first), min(leave, last)
    return enter < leave


def any_angle(known: Array, start: Cell, goal: Cell) -> float:
    """Length of the shortest path that may touch blocked cells: over the graph of what corners see of each other."""
    blocked = np.argwhere(known == BLOCKED)  # [n, 2]
    corners = {(2 * r + i, 2 * c + j) for r, c in blocked.tolist() for i in (-1, 1) for j in (-1, 1)}
    ends = [(2 * start[0], 2 * start[1]), (2 * goal[0], 2 * goal[1])]  # half cells
    graph = nx.Graph()
    for a, b in combinations([*ends, *corners], 2):
        if not any(crosses(np.array(a), np.array(b), cell) for cell in blocked):
            graph.add_edge(a, b, weight=math.dist(a, b) / 2)
    return float(nx.dijkstra_path_length(graph, *ends))


@pytest.mark.parametrize("name", PLANNERS)
@given(seed=st.integers(1, 2**31))
@settings(max_examples=20)
def test_a_plan_is_a_clear_path_over_neighbouring_cells(name: str, seed: int) -> None:
    """Every planner finds the goal; its motions are clear, and its cells are free, in order, from start to goal."""
    found = plan(WALL, START, GOAL, RrtStar(planner=name), seed)
    assert found.exact
    assert found.vertices >= len(found.states)
    assert (found.states[0].tolist(), found.states[-1].tolist()) == (list(START), list(GOAL))
    assert all(clear(WALL, *a, *b) for a, b in pairwise(found.states))
    way = np.stack(np.divmod(found.cells, 8), axis=1)  # [m, 2]
    assert (tuple(way[0]), tuple(way[-1])) == (START, GOAL)
    assert (np.abs(np.diff(way, axis=0)).sum(axis=1) == 1).all()
    assert (WALL.flat[found.cells] != BLOCKED).all()


def test_a_plan_repeats() -> None:
    """The same seed gives the same plan: again, with other planners in between, and in a process of its own."""
    first = plans()
    assert plans() == first
    code = "import json, sys, runpy; print(json.dumps(runpy.run_path(sys.argv[1])['plans']()))"
    fresh = subprocess.run([sys.executable, "-c", code, __file__], capture_output=True, text=True, check=True)
    assert json.loads(fresh.stdout) == first


def test_another_seed_is_another_plan() -> None:
    """Luck comes from the seed, up to the last one."""
    found = [plan(WALL, START, GOAL, RrtStar(), seed) for seed in (1, 2, rrt_star.SEEDS)]
    assert all(words(a) != words(b) for a, b in combinations(found, 2))


def test_rrt_star_is_near_the_shortest_any_angle_path() -> None:
    """On strewn maps no path is shorter than the visibility graph's, and none longer than a twentieth over A*'s."""
    for seed in range(12):
        known, start, goal = strewn(seed)
        found = plan(known, start, goal, RrtStar(), seed + 1)
        assert found.exact
        assert found.length >= any_angle(known, start, goal) - len(found.states) / PARTS
        assert found.length <= 1.05 * (len(search(known, start, goal)[0]) - 1)


def test_length_is_euclidean() -> None:
    """A path of motions of 5 and 2 cells is 7 cells long; none is 0 long."""
    states = np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 6.0]])
    assert Plan(states, np.empty(0, np.int32), 3, exact=True).length == 7.0
    assert Plan(states[:0], np.empty(0, np.int32), 0, exact=False).length == 0.0


def test_more_iterations_are_a_larger_tree_and_a_shorter_path() -> None:
    """RRT* stops by its count of iterations, and uses them to improve."""
    known, start, goal = np.zeros((30, 30), np.uint8), (0, 0), (29, 20)
    known[15, 5:25] = BLOCKED
    few, many = (plan(known, start, goal, RrtStar(iterations=count), 1) for count in (300, 3000))
    assert few.vertices <= 301
    assert few.vertices < many.vertices
    assert few.length > many.length


def test_a_goal_out_of_reach_is_approached() -> None:
    """The path then ends at the state nearest to the goal that was reached, here a wall away."""
    known = np.zeros((3, 9), np.uint8)
    known[:, 5] = BLOCKED
    found = plan(known, (1, 1), (1, 7), RrtStar(), 1)
    assert not found.exact
    assert 4.0 < found.states[-1][1] < 4.5
    assert found.cells[0] == 9 + 1
    assert found.cells[-1] % 9 == 4


@given(seeds)
@settings(max_examples=40)
def test_every_goal_is_reached_by_moves_onto_free_cells(explore: Callable[..., Any], seed: int) -> None:
    """Where a collision is failure, the agent reaches the goal of any map of rectangles."""
    conditions = GridConditions.model_validate({"budget": {"steps": 500}, "sensor": {"radius": 2}})
    family = Blobs(size=16, obstacles=(0, 12), obstacle_size=(1, 4))
    world = family.sample(np.random.default_rng(seed), 0, conditions)
    *_, last = explore(RrtStar(iterations=300), world, np.random.default_rng(seed))
    assert last.step is not None
    assert last.step.reached
    assert not last.step.collided


@pytest.mark.parametrize("name", PLANNERS)
@given(seeds, st.sampled_from([0.0, 0.2]), st.sampled_from(["stay", "sideways"]))
@settings(max_examples=15)
def test_slips_and_false_readings_are_survived(
    strew: Callable[..., GridWorld], explore: Callable[..., Any], name: str, seed: int, noise: float, slip_to: str
) -> None:
    """Whatever it is told and wherever it ends up, it answers with a move or gives up, and carries what it says."""
    rng = np.random.default_rng(seed)
    rules = {"collision": "blocked", "slip": 0.3, "slip_to": slip_to}
    world = strew(rng, steps=30, sensor={"radius": 1, "false_readings": noise}, rules=rules)
    for agent, _, action, _ in explore(RrtStar(planner=name, iterations=100), world, rng):
        assert action is None or type(action) is Move
        assert agent.memory_bytes() == agent.known.cells.nbytes + agent.route.cells.nbytes


def test_it_plans_again_only_when_its_path_is_cut(
    monkeypatch: pytest.MonkeyPatch, strew: Callable[..., GridWorld], explore: Callable[..., Any]
) -> None:
    """Over 30 worlds, each plan but the first was asked for with a blocked cell on the path ahead, or at its end."""
    asked: list[bool] = []
    ahead = np.empty(0, np.int32)

    def counted(known: Array, start: Cell, *rest: Any) -> Plan:
        asked.append(len(ahead) < 2 or bool((known.flat[ahead] == BLOCKED).any()))
        return plan(known, start, *rest)

    monkeypatch.setattr(rrt_star, "plan", counted)
    for seed in range(30):
        ahead = np.empty(0, np.int32)
        world = strew(np.random.default_rng(seed), side=24)
        for agent, *_ in explore(RrtStar(iterations=500), world, np.random.default_rng(seed)):
            ahead = agent.route.cells[agent.route.at + 1 :]
    assert len(asked) > 60
    assert all(asked)


def test_search_effort_is_that_of_all_plans(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """In a corridor one plan is enough, and its vertices are the whole effort."""
    moments = list(explore(RrtStar(iterations=50), draw("S..G"), np.random.default_rng(0)))
    seed = int(np.random.default_rng(0).integers(1, rrt_star.SEEDS, endpoint=True))
    known = np.zeros((1, 4), np.uint8)
    vertices = plan(known, (0, 0), (0, 3), RrtStar(iterations=50), seed).vertices
    assert [moment.agent.search_nodes() for moment in moments] == [vertices] * 3
    assert [moment.action for moment in moments] == [Move.RIGHT] * 3


def test_a_closed_map_leaves_the_current_view(misled: Callable[..., Any]) -> None:
    """With the goal read as blocked it gives up; once the goal is out of view, it plans on the view alone."""
    actions, expanded = misled(RrtStar())
    assert actions == [None, Move.RIGHT]
    assert expanded[0] < expanded[1]


def test_a_goal_underfoot_leaves_no_move(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """Where the goal does not count before a post was visited, standing on it is the end, as for A*."""
    *_, last = explore(RrtStar(), draw("P#.\n##.\nS.G"), np.random.default_rng(0))
    assert (last.observation.place, last.action) == ((2, 2), None)


def test_moving_down_is_a_move(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """A path that begins with the move numbered 0 is followed, without a look at the view alone."""
    moments = list(explore(RrtStar(iterations=50), draw("S\n.\nG"), np.random.default_rng(0)))
    assert [moment.action for moment in moments] == [Move.DOWN] * 2
    assert moments[0].agent.search_nodes() == moments[1].agent.search_nodes()
