"""Agents on graphs, held against plain searches on a plain record of what they have seen."""

from collections import Counter, deque
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import networkx as nx
import numpy as np
import pytest
from scipy.stats import chisquare

from fogbench.planners.astar import AStar
from fogbench.planners.breadth_first import BreadthFirst
from fogbench.planners.dstar_lite import DStarLite
from fogbench.planners.graph.judge import GraphJudge
from fogbench.planners.nearest_unvisited import NearestUnvisited
from fogbench.planners.random_walk import RandomWalk
from fogbench.worlds.graph.world import GraphWorld

On = Callable[..., GraphWorld]

FORMS = ("unit", "lengths", "coordinates")

ROAD: Any = nx.Graph([(0, 1), (0, 2), (1, 3), (2, 4), (3, 5), (4, 5), (5, 6)])
"""Two ways of as many edges from 0 to 6."""


@pytest.fixture
def tasks(on: On, weave: Callable[..., Any]) -> Callable[..., Iterator[tuple[int, Any, GraphWorld]]]:
    """Makes tasks of a form from a node to another on random graphs: a seed, the graph of networkx, and the world."""

    def make(form: str, count: int, most: int) -> Iterator[tuple[int, Any, GraphWorld]]:
        for seed in range(count):
            rng = np.random.default_rng(seed)
            source = weave(rng, form, most)
            start, goal = rng.choice(len(source), 2, replace=False).tolist()
            yield seed, source, on(source, start, goal, slip=0.2 * (seed % 2))

    return make


def best(graph: Any, place: int, targets: set[int]) -> set[int]:
    """The first steps of all shortest paths to the nearest targets: of all simple paths those that are no longer."""
    ways = [path for target in targets - {place} for path in nx.all_simple_paths(graph, place, target)]
    lengths = [sum(graph.edges[edge]["length"] for edge in pairwise(path)) for path in ways]
    return {path[1] for path, length in zip(ways, lengths, strict=True) if length < min(lengths) * (1 + 1e-6)}


@pytest.mark.parametrize("form", FORMS)
def test_the_judge_and_the_reference_agree_with_all_shortest_paths(
    tasks: Any, explore: Any, notes: Any, form: str
) -> None:
    """To a goal that was seen, else to all nearest nodes not visited; the reference takes the least number of them."""
    several = 0
    for seed, _, world in tasks(form, 60, most=8):
        plain, judge = notes(), GraphJudge(world.task)
        for moment in explore(NearestUnvisited(), world, np.random.default_rng(seed)):
            plain.see(moment.observation)
            judge.see(moment.observation)
            goal = {world.task.goal} & {*plain.graph}
            right = best(plain.graph, moment.observation.place, goal or {*plain.graph} - plain.visited)
            assert set(np.flatnonzero(judge.targets()).tolist()) == right
            assert moment.action == min(right)
            for node in world.task.goal, *plain.graph:
                verdict = (True, node not in right, node != min(right))
                assert judge.judge(node) == verdict
            several += len(right) > 1
    assert several > {"coordinates": 0}.get(form, 10)


def test_where_all_was_visited_nothing_is_judged(on: On) -> None:
    """A goal that no known edge leads to is in another part of the graph, and the agents give up."""
    task = on(nx.path_graph(3), 0, 2).task._replace(extent=(4,), goal=3)
    view = on(nx.Graph([(0, 1), (1, 2), (2, 3)]), 1, 3)
    for settings in (NearestUnvisited(), BreadthFirst(), AStar(), DStarLite()):
        agent, judge = settings.start(task, np.random.default_rng(0)), GraphJudge(task)
        for place in (1, 0, 2):
            seen = view.sense(view.reset()._replace(place=place), np.random.default_rng(0))
            hidden = seen.view.copy()
            hidden[3] = np.inf  # there is no way to the goal
            action = agent.act(seen._replace(view=hidden))
            judge.see(seen._replace(view=hidden))
        assert action is None
        assert judge.judge(1) == (False, False, False)
        assert not judge.targets().any()


@pytest.mark.parametrize("form", FORMS)
def test_breadth_first_goes_by_a_plain_queue(tasks: Any, explore: Any, notes: Any, form: str) -> None:
    """Nodes wait in the order in which they were first seen; the goal comes first once it is among them."""
    for seed, _, world in tasks(form, 60, most=9):
        plain, queue, before = notes(), deque[int](), set[int]()
        for moment in explore(BreadthFirst(), world, np.random.default_rng(seed)):
            plain.see(moment.observation)
            queue.extend(sorted({*plain.graph} - before - {moment.observation.place}))
            before = {*plain.graph}
            while queue[0] in plain.visited:
                queue.popleft()
            target = world.task.goal if world.task.goal in before else queue[0]
            assert moment.action == min(best(plain.graph, moment.observation.place, {target}))


@pytest.mark.parametrize("settings", [AStar(), DStarLite()], ids=["astar", "dstar_lite"])
@pytest.mark.parametrize("form", FORMS)
def test_ways_are_as_short_as_supposed_edges_let_them_be(
    tasks: Any, explore: Any, notes: Any, form: str, settings: Any
) -> None:
    """At every decision the step begins a way that is shortest by networkx, so both agents go as far.

    There a straight edge to the goal is supposed from each node that was seen and not visited.
    """
    decisions = 0
    for seed, source, world in tasks(form, 150, most=30):
        plain, goal = notes(), world.task.goal
        for moment in explore(settings, world, np.random.default_rng(seed)):
            plain.see(moment.observation)
            supposed, place = plain.graph.copy(), moment.observation.place
            for node in {*plain.graph} - plain.visited - {goal}:
                supposed.add_edge(node, goal, length=straight(source, node, goal))
            ahead = nx.single_source_dijkstra_path_length(supposed, goal, weight="length")
            step = plain.graph.edges[place, moment.action]["length"]
            assert step + ahead[moment.action] == pytest.approx(ahead[place], rel=1e-6)
            decisions += 1
    assert decisions > 500


def straight(source: Any, a: int, b: int) -> float:
    """The straight line between two nodes; 0 where they are nowhere."""
    ends = [(source.nodes[node].get("x", 0), source.nodes[node].get("y", 0)) for node in (a, b)]
    return float(np.hypot(*np.subtract(*ends)))


@pytest.mark.parametrize("form", ["unit", "lengths"])
def test_without_coordinates_d_star_lite_goes_to_the_nearest_node(tasks: Any, explore: Any, form: str) -> None:
    """A supposed edge of no length makes the nearest node not visited the best; ties go to the least number.

    Only where edges have lengths, the reference goes to a goal in view though another node is nearer.
    """
    for seed, _, world in tasks(form, 60, most=30):
        moments = explore(DStarLite(), world, np.random.default_rng(seed))
        for other in explore(NearestUnvisited(), world, np.random.default_rng(seed)):
            if form == "lengths" and np.isfinite(other.observation.view[world.task.goal, 0]):
                break
            assert next(moments).action == other.action


def test_a_walk_takes_any_neighbour_and_the_goal_beside_it(on: On) -> None:
    """6000 draws are compatible with the uniform law over neighbours; a goal among them is always taken."""
    star = nx.star_graph(4)
    star.add_edge(4, 5)
    world = on(star, 0, 5)
    walker, luck = RandomWalk().start(world.task, np.random.default_rng(1)), np.random.default_rng(0)
    here = world.sense(world.reset(), luck)
    counts = Counter(walker.act(here) for _ in range(6000))
    assert set(counts) == {1, 2, 3, 4}
    assert chisquare(list(counts.values())).pvalue > 0.01
    beside = world.sense(world.reset()._replace(place=4), luck)
    assert {walker.act(beside) for _ in range(100)} == {5}


EPISODES: list[tuple[Any, list[int]]] = [
    (NearestUnvisited(), [1, 3, 5, 6]),
    (BreadthFirst(), [1, 0, 2, 0, 1, 3, 1, 0, 2, 4, 5, 6]),
    (AStar(), [1, 3, 5, 6]),
    (DStarLite(), [1, 3, 5, 6]),
]


@pytest.mark.parametrize(("settings", "actions"), EPISODES, ids=lambda value: type(value).__name__)
def test_an_episode_followed_by_hand(on: On, explore: Any, settings: Any, actions: list[int]) -> None:
    """Breadth-first search walks from side to side, to keep the order in which it saw nodes; the others go on."""
    moments = explore(settings, on(ROAD, 0, 6), np.random.default_rng(0))
    assert [moment.action for moment in moments] == actions


def test_a_straight_line_leads_by_the_short_side(on: On, explore: Any) -> None:
    """Where nodes lie, A* and D* Lite go towards the goal, the reference to the nearest node, which lies away."""
    source = nx.Graph([(0, 1), (0, 2), (2, 3), (1, 4)])
    nx.set_node_attributes(source, {0: (0, 0), 1: (-1, 0), 2: (2, 0), 3: (4, 0), 4: (-2, 0)}, "pos")
    expected = {AStar(): [2, 3], DStarLite(): [2, 3], NearestUnvisited(): [1, 4, 1, 0, 2, 3]}
    for settings, actions in expected.items():
        moments = explore(settings, on(source, 0, 3), np.random.default_rng(0))
        assert [moment.action for moment in moments] == actions


def test_bytes_are_those_of_what_is_carried(on: On, explore: Any) -> None:
    """Of 7 nodes: the known graph; a queue of 4 bytes a node; costs and keys of 32 a node, and 64 rows of 24."""
    known, last = 5 * 7 + 16 * 64, {}
    for settings in (NearestUnvisited(), AStar(), BreadthFirst(), DStarLite(), RandomWalk()):
        for moment in explore(settings, on(ROAD, 0, 6), np.random.default_rng(0)):
            last[type(settings).__name__] = moment.agent.memory_bytes()
    assert last == {
        "NearestUnvisited": known,
        "AStar": known,
        "BreadthFirst": known + 4 * 7,
        "DStarLite": known + 32 * 7 + 24 * 64,
        "RandomWalk": 0,
    }


def test_d_star_lite_expands_less_than_a_star(tasks: Any, explore: Any) -> None:
    """Repairs are worth their bytes: over 40 tasks it expands fewer nodes in all."""
    expanded = Counter[str]()
    for seed, _, world in tasks("coordinates", 40, most=100):
        for settings in (AStar(), DStarLite()):
            *_, last = explore(settings, world, np.random.default_rng(seed))
            expanded[type(settings).__name__] += last.agent.search_nodes()
    assert expanded["DStarLite"] < expanded["AStar"]
