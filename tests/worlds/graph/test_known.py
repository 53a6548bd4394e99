"""The known graph, held against a plain record by networkx."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fogbench.worlds.graph.known import NONE, KnownGraph
from fogbench.worlds.graph.world import GraphWorld


def links_of(known: KnownGraph, node: int) -> dict[int, float]:
    """The nodes that known edges join with one, and their lengths."""
    found, link = [], known.heads[node]
    while link != NONE:
        found.append((int(known.links[link, 1]), float(known.lengths[link])))
        link = known.links[link, 0]
    assert len(dict(found)) == len(found)
    return dict(found)


@pytest.mark.parametrize("form", ["unit", "lengths", "coordinates"])
def test_the_known_graph_is_the_plain_record(
    on: Callable[..., GraphWorld], weave: Callable[..., Any], notes: Any, form: str
) -> None:
    """After each step of 60 random walks: nodes visited, edges with their lengths, coordinates of what was in view."""
    for seed in range(60):
        rng = np.random.default_rng(seed)
        source = weave(rng, form, most=40)
        world, plain = on(source, 0, len(source) - 1), notes()
        known, state = world.known(), world.reset()
        for _ in range(20):
            observation = world.sense(state, rng)
            plain.see(observation)
            known.update(observation)
            assert set(np.flatnonzero(known.visited).tolist()) == plain.visited
            for node in range(len(source)):
                row = plain.graph.adj[node] if node in plain.graph else {}
                assert links_of(known, node) == {other: edge["length"] for other, edge in row.items()}
            assert sorted(map(tuple, known.edges.tolist())) == sorted(tuple(sorted(edge)) for edge in plain.graph.edges)
            if form == "coordinates":
                told = {*plain.graph, world.task.goal}
                places = [[source.nodes[n]["x"], source.nodes[n]["y"]] if n in told else [np.inf] * 2 for n in source]
                assert known.coordinates.tolist() == places
            state = world.step(state, int(rng.choice(world.graph.row(state.place))), rng).state


def test_a_node_is_taken_in_once(on: Callable[..., GraphWorld], weave: Callable[..., Any]) -> None:
    """The second look from a node tells nothing new, and says so."""
    source = weave(np.random.default_rng(0), "lengths")
    world = on(source, 0, 1)
    known, observation = world.known(), world.sense(world.reset(), np.random.default_rng(0))
    assert known.update(observation)
    before, used = known.bytes, known.used
    assert not known.update(observation)
    assert (known.bytes, known.used) == (before, used)


def test_bytes_are_those_of_the_arrays(on: Callable[..., GraphWorld], weave: Callable[..., Any]) -> None:
    """5 for each node and 16 for each link that there is room for; 16 more for each node where it has coordinates."""
    for form, more in (("unit", 0), ("coordinates", 16)):
        source = weave(np.random.default_rng(2), form)
        world = on(source, 0, 1)
        known = world.known()
        assert known.bytes == 5 * len(source) + 16 * 64
        known.update(world.sense(world.reset(), np.random.default_rng(0)))
        assert known.bytes == (5 + more) * len(source) + 16 * 64
