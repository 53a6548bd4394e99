"""The graph world, step by step through episodes small enough to follow by hand."""

from collections.abc import Callable
from typing import Any

import networkx as nx
import numpy as np
import pytest

from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.types import Budget, Step

On = Callable[..., GraphWorld]

INF = np.inf

KITE: Any = nx.Graph()
KITE.add_weighted_edges_from([(0, 1, 2), (0, 2, 4), (1, 2, 1), (2, 3, 2.5), (3, 4, 1)], "length")
"""From 0 to 4 the shortest way is 0 1 2 3 4, over 6.5; the fewest edges are three."""

SQUARE: Any = nx.Graph([(0, 1), (1, 2), (2, 3)])
nx.set_node_attributes(SQUARE, {0: (0, 0), 1: (3, 0), 2: (3, 4), 3: (0, 4)}, "pos")


class Luck:
    """Stands in for a generator: hands out the numbers it was given."""

    def __init__(self, *numbers: float) -> None:
        """Numbers in the order in which they are drawn."""
        self.numbers = list(numbers)

    def random(self) -> float:
        """The next."""
        return self.numbers.pop(0)


def walk(world: GraphWorld, *nodes: int, luck: Any = None) -> list[Step]:
    """What each action of an episode did."""
    state, steps = world.reset(), []
    for node in nodes:
        steps.append(world.step(state, node, luck))
        state = steps[-1].state
    return steps


def test_an_episode_to_the_goal(on: On) -> None:
    """A step leads along an edge and is as long; only the goal ends it, nothing collides."""
    steps = walk(on(KITE, 0, 4), 1, 2, 3, 4)
    assert [step.state for step in steps] == [(1, 1, False), (2, 2, False), (3, 3, False), (4, 4, False)]
    assert [step.length for step in steps] == [2.0, 1.0, 2.5, 1.0]
    assert [step.reached for step in steps] == [False, False, False, True]
    assert not any(step.collided for step in steps)


@pytest.mark.parametrize("node", [0, 3, 4])
def test_what_is_no_neighbour_is_blocked(on: On, node: int) -> None:
    """A step is used up and the agent is told; the next good step clears it. No edge leads from a node to itself."""
    world = on(KITE, 0, 4)
    stopped, moved = walk(world, node, 2)
    assert stopped == ((1, 0, True), 0.0, False, False)
    assert moved == ((2, 2, False), 4.0, False, False)
    assert world.sense(stopped.state, Luck()).blocked
    assert not world.sense(moved.state, Luck()).blocked


def test_a_slip_stays(on: On) -> None:
    """Below its probability the step leads nowhere and has no length; at it, it works. One number is drawn a step."""
    luck = Luck(0.24, 0.25, 0.0, 0.9)
    steps = walk(on(KITE, 0, 4, slip=0.25), 2, 2, 4, 4, luck=luck)
    assert [step.state for step in steps] == [(1, 0, False), (2, 2, False), (3, 2, True), (4, 2, True)]
    assert [step.length for step in steps] == [0.0, 4.0, 0.0, 0.0]
    assert luck.numbers == []


def test_without_slips_no_number_is_drawn(on: On) -> None:
    """Neither by a look nor by a step."""
    world, luck = on(KITE, 0, 4), np.random.default_rng(0)
    world.sense(world.reset(), luck)
    world.step(world.reset(), 1, luck)
    assert luck.random() == np.random.default_rng(0).random()


@pytest.mark.parametrize(
    ("action", "got"),
    [
        (5, "5 (int)"),
        (-1, "-1 (int)"),
        ("1", "'1' (str)"),
        (1.0, "1.0 (float)"),
        (True, "True (bool)"),
        (np.int32(1), "np.int32(1) (int32)"),
        ((1,), "(1,) (tuple)"),
    ],
)
def test_what_is_no_node_is_refused(on: On, action: object, got: str) -> None:
    """Only a plain number of a node is one, and the error says what was got."""
    world = on(KITE, 0, 4)
    with pytest.raises(TypeError) as caught:
        world.step(world.reset(), action, Luck())
    assert str(caught.value) == f"act returned {got}; expected a node, an int from 0 to 4, or None"


def test_a_view_is_the_row_of_the_node(on: On) -> None:
    """The lengths of the edges that lead to each node; infinite where none does. It cannot be written."""
    world = on(KITE, 0, 4)
    states = [world.reset(), *(step.state for step in walk(world, 2, 3))]
    seen = [world.sense(state, Luck()) for state in states]
    assert [observation.view[:, 0].tolist() for observation in seen] == [
        [INF, 2, 4, INF, INF],
        [4, 1, INF, 2.5, INF],
        [INF, INF, 2.5, INF, 1],
    ]
    assert [(observation.step, observation.place) for observation in seen] == [(0, 0), (1, 2), (2, 3)]
    assert seen[0].view.shape == (5, 1)
    with pytest.raises(ValueError, match="read-only"):
        seen[0].view[0] = 1


def test_coordinates_are_seen_of_what_is_near_and_of_the_goal(on: On) -> None:
    """Those of the agent's node, of its neighbours and of the goal."""
    world = on(SQUARE, 0, 3)
    first, second = (world.sense(state, Luck()).view for state in (world.reset(), walk(world, 1)[0].state))
    assert first.tolist() == [[INF, 0, 0], [3, 3, 0], [INF, INF, INF], [INF, 0, 4]]
    assert second.tolist() == [[3, 0, 0], [INF, 3, 0], [4, 3, 4], [INF, 0, 4]]


def test_facts_of_a_world(on: On) -> None:
    """The optimum by lengths, what remains of it, the straight line, and the covariates, counted by hand."""
    world = on(KITE, 0, 4)
    assert (world.shortest(), world.straight(), world.hops) == (6.5, 0.0, 3)
    assert world.covariates() == {"nodes": 5.0, "mean_degree": 2.0, "hops": 3.0}
    assert [world.remaining(world.reset()._replace(place=node)) for node in range(5)] == [6.5, 4.5, 3.5, 1.0, 0.0]
    assert (on(SQUARE, 0, 3).shortest(), on(SQUARE, 0, 3).straight()) == (10.0, 4.0)
    assert world.action(3.0) == 3
    assert type(world.action(3.0)) is int


def test_a_budget_grows_with_the_straight_line(on: On) -> None:
    """Where nodes are nowhere, nothing is known of it, and what is added remains."""
    steps = {"per_distance": 2.5, "plus": 3}
    assert on(SQUARE, 0, 3, steps=steps).task.budget == Budget(13)
    assert on(KITE, 0, 4, steps=steps).task.budget == Budget(3)
    assert on(KITE, 0, 4).task == ("graph", 4, None, Budget(100), (5,))


@pytest.mark.parametrize(
    ("fields", "fits"),
    [
        ({"steps": 3}, True),
        ({"steps": 2}, False),
        ({"steps": 2, "distance": (1, 9)}, True),
        ({"distance": (6, 7)}, True),
        ({"distance": (7, 9)}, False),
        ({"distance": (1, 6)}, False),
    ],
)
def test_tasks_out_of_bounds_are_none(on: On, fields: dict[str, Any], fits: bool) -> None:
    """Bounds hold the optimum by length; without them, the fewest edges must not be more than the steps."""
    assert (on(KITE, 0, 4, **fields) is not None) == fits


def test_a_task_has_a_way_to_another_node(on: On) -> None:
    """None starts at its goal, and none has its goal in another part."""
    parts = nx.Graph([(0, 1), (2, 3)])
    assert on(parts, 0, 0) is None
    assert on(parts, 0, 2, distance=(1, 9)) is None
    assert on(parts, 2, 3) is not None


def test_rules_know_their_bounds() -> None:
    """A slip is a probability."""
    with pytest.raises(ValueError, match=r"rules\.slip"):
        GraphConditions.model_validate({"budget": {"steps": 9}, "rules": {"slip": 1.5}})
