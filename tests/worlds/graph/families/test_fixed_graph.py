"""One graph for all episodes: which pairs of start and goal are learned from, and which are played."""

from typing import Any

import numpy as np
import pytest

from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.families.fixed_graph import FixedGraph, part
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.types import MapError

PARTS = ("training", "validation", "test")

OPEN = GraphConditions.model_validate({"budget": {"steps": 100}})
"""Whatever the pair, it fits."""


def family(pairs: str = "test", **fields: Any) -> FixedGraph:
    """A graph of 16 nodes."""
    return FixedGraph.model_validate({"nodes": 16, "mean_degree": 3, "pairs": pairs, **fields})


def ends(world: GraphWorld) -> tuple[int, int]:
    """Start and goal."""
    return world.start, world.task.goal


def test_the_parts_share_no_pair() -> None:
    """Each of the 240 pairs is in just one: half to learn from, a tenth to try on meanwhile, the rest to play."""
    training, validation, test = ([tuple(pair) for pair in part(family(pairs)).tolist()] for pairs in PARTS)
    assert (len(training), len(validation), len(test)) == (120, 24, 96)
    assert {*training, *validation, *test} == {(a, b) for a in range(16) for b in range(16) if a != b}


def test_each_test_pair_is_played_once() -> None:
    """The episodes of a scenario are all of them, on one graph, none of which is drawn for training or validation."""
    assert family().tasks(OPEN, 1000) == 96
    worlds = [family().sample(np.random.default_rng(9), episode, OPEN) for episode in range(96)]
    assert len({ends(world) for world in worlds}) == 96
    for pairs, count in (("training", 120), ("validation", 24)):
        others = [family(pairs).sample(np.random.default_rng(seed), 0, OPEN) for seed in range(1500)]
        assert len({ends(world) for world in others}) == count
        assert not {ends(world) for world in others} & {ends(world) for world in worlds}
        assert {world.graph for world in others} == {worlds[0].graph}


def test_pairs_to_learn_from_have_no_end() -> None:
    """Each episode draws one, whatever its number."""
    assert family("training").tasks(OPEN, 1000) is None
    drawn = [ends(family("training").sample(np.random.default_rng(3), episode, OPEN)) for episode in (0, 10**6)]
    assert drawn[0] == drawn[1]


def test_pairs_out_of_bounds_are_not_played() -> None:
    """What fits the conditions counts, in the same order as without them."""
    far = GraphConditions.model_validate({"budget": {"steps": 100}, "tasks": {"distance": [3, 9]}})
    every = [family().sample(np.random.default_rng(0), episode, OPEN) for episode in range(96)]
    fitting = [ends(world) for world in every if 3 <= world.shortest() <= 9]
    count = family().tasks(far, 1000)
    assert count == len(fitting) > 5
    assert [ends(family().sample(np.random.default_rng(0), episode, far)) for episode in range(count)] == fitting


def test_a_number_names_another_graph() -> None:
    """The same number names the same one, in other settings another."""
    lines = [
        family(**fields).sample(np.random.default_rng(seed), 0, OPEN).graph.lines.tolist()
        for seed, fields in enumerate([{}, {}, {"number": 1}, {"mean_degree": 3.5}])
    ]
    assert lines[0] == lines[1]
    assert lines[0] not in lines[2:]


def test_more_episodes_than_pairs_are_told() -> None:
    """In one line, with the number that there is."""
    with pytest.raises(MapError) as caught:
        family().sample(np.random.default_rng(0), 96, OPEN)
    wanted = "a path inside the step budget (set by `budget: {steps: ...}`)"
    told = f"FixedGraph: 96 tasks with {wanted} for 97 episodes; set `episodes: 96`, or give a larger graph"
    assert str(caught.value) == told


def test_pairs_that_never_fit_are_told() -> None:
    """Whatever part they are of."""
    never = GraphConditions.model_validate({"budget": {"steps": 100}, "tasks": {"distance": [90, 99]}})
    for pairs in PARTS:
        with pytest.raises(MapError, match="FixedGraph: 0 tasks with an optimum of 90 to 99 "):
            family(pairs).sample(np.random.default_rng(0), 0, never)
