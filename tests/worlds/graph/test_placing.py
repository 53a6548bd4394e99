"""Pictures of graphs: nodes stay where they are, and what is known lies over what is."""

from collections.abc import Callable
from typing import Any

import networkx as nx
import numpy as np
import pytest

from fogbench.worlds.graph import placing
from fogbench.worlds.graph.networks import converted
from fogbench.worlds.graph.placing import drawn_at
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.types import Array

RING: Any = nx.cycle_graph(6)

PLACED: Any = nx.Graph([(0, 1), (1, 2)])
nx.set_node_attributes(PLACED, {0: (0, 0), 1: (40, 0), 2: (40, 10)}, "pos")


def points(layer: Any) -> list[Any]:
    """Those of some dots, or the ends of some lines."""
    found: Array = layer[0]
    return [*map(tuple, found.reshape(-1, 2).tolist())]


def test_nodes_stay_where_they_are(on: Callable[..., GraphWorld]) -> None:
    """From step to step each node has one place, and the agent, its path and the goal are drawn there."""
    world, luck, path = on(RING, 0, 3), np.random.default_rng(0), [0]
    state, known = world.reset(), world.known()
    at = points(world.picture(known, world.sense(state, luck), path).truth[1])
    for node in (1, 2, 3):
        state = world.step(state, node, luck).state
        observation = world.sense(state, luck)
        known.update(observation)
        path.append(node)
        picture = world.picture(known, observation, path)
        assert points(picture.truth[1]) == at
        assert points(picture.agent) == [at[node]]
        assert points(picture.path) == [at[each] for each in path]
        assert points(picture.goal) == [at[3]]
        assert {*points(picture.view)} == {at[node], at[node - 1], at[(node + 1) % 6]}


def test_the_known_graph_is_part_of_the_truth(on: Callable[..., GraphWorld]) -> None:
    """Its edges and nodes grow from nothing to all."""
    world, luck = on(RING, 0, 3), np.random.default_rng(0)
    state, known, counts = world.reset(), world.known(), []
    for node in (1, 2, 3, 4, 5):
        observation = world.sense(state, luck)
        picture = world.picture(known, observation, [state.place])
        (lines, dots), (truth, all_) = picture.known, picture.truth
        assert {*points(lines)} <= {*points(truth)}
        assert {*points(dots)} <= {*points(all_)}
        counts.append((len(points(lines)) // 2, len(points(dots))))
        known.update(observation)
        state = world.step(state, node, luck).state
    assert counts == [(0, 0), (2, 3), (3, 4), (4, 5), (5, 6)]


def test_coordinates_are_drawn_with_y_upwards() -> None:
    """To scale, inside the picture, a wide graph in a wide picture."""
    at, (rows, columns) = drawn_at(converted(PLACED).graph)
    scale = at[1, 1] - at[0, 1]
    assert np.allclose(at - at[0], np.array([(0, 0), (0, scale), (-scale / 4, scale)]))
    assert (at >= 0).all()
    assert (at <= (rows, columns)).all()
    assert columns - 3 == pytest.approx(4 * (rows - 3))  # a margin is around both


@pytest.mark.parametrize("largest", [placing.LARGEST, 3])
def test_nodes_without_coordinates_are_drawn_apart(largest: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Inside the picture, no two in one place, in small graphs and in large ones."""
    monkeypatch.setattr(placing, "LARGEST", largest)
    at, (rows, columns) = drawn_at(converted(RING).graph)
    assert (at >= 0).all()
    assert (at <= (rows, columns)).all()
    assert min(np.hypot(*(a - b)) for k, a in enumerate(at) for b in at[:k]) > 0.5
