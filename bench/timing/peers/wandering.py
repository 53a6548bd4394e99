"""Whole episodes of the agent that goes to the nearest node it did not visit, beside the same agent on networkx.

Both play the same graphs of 1000 nodes, with a mean degree of 3, for at most 1000 steps. Before anything is timed, both
must go as far. The plain agent adds what it sees to a graph of networkx and asks that for the nearest node; drawing the
graphs is not timed, for both need them.
"""

from collections.abc import Callable, Iterator
from itertools import count, islice
from time import process_time

import networkx as nx
import numpy as np
from turns import Round, Turns, milliseconds

from fogbench.planners.nearest_unvisited import NearestUnvisited
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.families.random_graph import RandomGraph
from fogbench.worlds.graph.world import GraphWorld

EPISODES = 50
"""In a round; with 20 rounds, 1000 in all."""

GRAPHS = RandomGraph(nodes=1000, mean_degree=3)
CONDITIONS = GraphConditions.model_validate({"budget": {"steps": 1000}})
LUCK = np.random.default_rng(0)

Play = Callable[[GraphWorld], int]


def wanders() -> Iterator[Turns]:
    """Ours beside theirs."""
    for world in islice(worlds(), 5):
        if ours(world) != plain(world):
            raise SystemExit("the two agents differ in their steps")
    pair = in_rounds(ours), in_rounds(plain)
    yield Turns.take("nearest unvisited, 1000 nodes, an episode", "networkx", *pair, milliseconds)


def worlds() -> Iterator[GraphWorld]:
    """Fresh ones."""
    return (GRAPHS.sample(np.random.default_rng(number), number, CONDITIONS) for number in count())


def in_rounds(play: Play) -> Round:
    """Seconds per episode."""
    ahead = worlds()

    def one_round() -> float:
        drawn = list(islice(ahead, EPISODES))
        began = process_time()
        for world in drawn:
            play(world)
        return (process_time() - began) / EPISODES

    return one_round


def ours(world: GraphWorld) -> int:
    """Play an episode; its steps."""
    agent, state, over = NearestUnvisited().start(world.task, LUCK), world.reset(), False
    while not over:
        step = world.step(state, agent.act(world.sense(state, LUCK)), LUCK)
        state, over = step.state, step.reached or step.state.step >= world.task.budget.steps
    return state.step


def plain(world: GraphWorld) -> int:
    """The same by networkx: the truth is one of its graphs, and so is what is known."""
    truth, known, visited = nx.Graph(world.graph.lines.tolist()), nx.Graph(), set()
    place, goal, steps = world.start, world.task.goal, 0
    while place != goal and steps < world.task.budget.steps:
        visited.add(place)
        known.add_edges_from((place, node) for node in truth[place])
        place, steps = first_step(known, visited, place, goal), steps + 1
    return steps


def first_step(known: nx.Graph, visited: set[int], place: int, goal: int) -> int:
    """That of a shortest way to the goal or the nearest node not visited; of several, to the node of least number."""
    far, near = nx.single_source_shortest_path_length(known, place), set()
    targets = {goal} if goal in far else {*far} - visited
    least = min(far[node] for node in targets)
    near = {node for node in targets if far[node] == least}
    for depth in range(least - 1, 0, -1):  # back to the neighbours of the place
        near = {other for node in near for other in known[node] if far[other] == depth}
    return min(near)
