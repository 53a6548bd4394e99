"""Graphs side by side, held against `GraphWorld` one by one: step by step, bit for bit."""

from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fogbench.worlds.batch import batch_of
from fogbench.worlds.graph.batch import GraphBatch
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.families.random_graph import RandomGraph
from fogbench.worlds.graph.world import GraphState, GraphWorld
from fogbench.worlds.types import Array

WAXMAN = {"generator": "waxman_graph", "parameters": {"beta": 0.9, "alpha": 0.5}}

FAMILIES = [
    RandomGraph(nodes=2, mean_degree=1),
    RandomGraph(nodes=9, mean_degree=3),
    RandomGraph(nodes=30, density=0.3),
    RandomGraph.model_validate({"nodes": 7, **WAXMAN}),
    RandomGraph.model_validate({"nodes": 20, **WAXMAN}),
    RandomGraph(generator="grid_2d_graph", parameters={"m": 3, "n": 4}),
]

SETTINGS = st.tuples(st.sampled_from(FAMILIES), st.sampled_from([0.0, 0.3]), st.integers(2, 20))


@dataclass
class Alone:
    """One episode, played by its own world."""

    world: GraphWorld
    luck: np.random.Generator
    state: GraphState = field(init=False)

    def __post_init__(self) -> None:
        """Begin."""
        self.state = self.world.reset()

    def choice(self, luck: np.random.Generator) -> int:
        """A neighbour three times of four, else any node."""
        row = self.world.graph.row(self.state.place)
        return int(luck.choice(row) if luck.random() < 0.75 else luck.integers(self.world.graph.size))


def luck_of(number: int) -> np.random.Generator:
    """The luck of an episode."""
    return np.random.default_rng(number)


def world_of(made: tuple[RandomGraph, float, int], seed: int) -> GraphWorld:
    """A world of some settings."""
    family, slip, steps = made
    block = {"rules": {"slip": slip}, "budget": {"steps": steps}}
    return family.sample(luck_of(seed), 0, GraphConditions.model_validate(block))


def hold(batch: Any, alone: dict[int, Alone], luck: np.random.Generator) -> Array:
    """One step of all, in both forms; which slots go on."""
    slots = np.array(sorted(alone))
    told = batch.sense(slots)
    assert len(told) == len(slots)
    for k, slot in enumerate(slots.tolist()):
        one = alone[slot].world.sense(alone[slot].state, alone[slot].luck)
        assert told[k]._replace(view=0) == one._replace(view=0)
        assert np.array_equal(told[k].view, one.view)
        assert not told[k].view.flags.writeable
    chosen = [alone[slot].choice(luck) for slot in slots.tolist()]
    done = batch.step(slots, chosen)
    for k, slot in enumerate(slots.tolist()):
        each = alone[slot]
        step = each.world.step(each.state, chosen[k], each.luck)
        each.state = step.state
        assert (done.lengths[k], done.collided[k], done.reached[k]) == (step.length, step.collided, step.reached)
        assert done.spent[k] == (step.state.step >= each.world.task.budget.steps)
        assert done.over[k] == (done.reached[k] or done.spent[k])
    return slots[~done.over]


@settings(max_examples=150, deadline=None)
@given(made=st.lists(SETTINGS, min_size=1, max_size=5), seed=st.integers(0, 2**32 - 1), anew=st.booleans())
def test_a_batch_is_its_worlds(made: list[tuple[Any, Any, int]], seed: int, anew: bool) -> None:
    """Whatever sizes, lengths, coordinates and slips stand side by side, and whichever slots get other episodes."""
    worlds = [world_of(each, seed + k) for k, each in enumerate(made)]
    batch, live = batch_of(worlds), np.arange(len(worlds))
    assert isinstance(batch, GraphBatch)
    batch.reset(live, worlds, [partial(luck_of, seed + k) for k in range(len(worlds))])
    alone = {k: Alone(world, luck_of(seed + k)) for k, world in enumerate(worlds)}
    luck = luck_of(seed)
    for turn in range(20):
        live = hold(batch, alone, luck)
        for slot in alone.keys() - {*live.tolist()}:
            del alone[slot]
            if anew:
                fresh = world_of(made[turn % len(made)], seed + 100 + turn)
                batch.reset(np.array([slot]), [fresh], [partial(luck_of, turn)])
                alone[slot] = Alone(fresh, luck_of(turn))
        if not alone:
            break


@pytest.mark.parametrize("node", [-1, 9])
def test_no_node(node: int) -> None:
    """What is no node of its own graph is refused before anything moves, though another graph has it."""
    worlds = [world_of((FAMILIES[1], 0.0, 9), 1), world_of((FAMILIES[2], 0.0, 9), 2)]
    batch = batch_of(worlds)
    batch.reset(np.arange(2), worlds, [partial(luck_of, k) for k in range(2)])
    other = int(worlds[1].graph.row(worlds[1].start)[0])
    with pytest.raises(TypeError) as caught:
        batch.step(np.arange(2), [node, other])
    assert str(caught.value) == f"got the nodes {sorted({node, other})}; expected those of the graphs, from 0"
    assert [told.place for told in batch.sense(np.arange(2))] == [world.start for world in worlds]
