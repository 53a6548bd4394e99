"""Random steps on fresh graphs of 16 nodes, side by side; and the reference on graphs of 1000, beside plain networkx.

    pytest bench/timing/test_graphs.py -s

Graphs, resets and looks count. The plain agent is in `peers/wandering.py`, which times both by turns.
"""

from functools import partial
from itertools import count
from typing import Any

import numpy as np
from pytest_benchmark.fixture import BenchmarkFixture

from fogbench.planners.nearest_unvisited import NearestUnvisited
from fogbench.worlds.graph.batch import GraphBatch
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.families.random_graph import RandomGraph
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.streams import stream
from fogbench.worlds.types import Array

GRAPHS, STEPS = RandomGraph(nodes=16, mean_degree=3), GraphConditions.model_validate({"budget": {"steps": 40}})
LARGE, MANY = RandomGraph(nodes=1000, mean_degree=3), GraphConditions.model_validate({"budget": {"steps": 1000}})
SLOTS, TURNS, EPISODES = 256, 40, 10
"""Worlds side by side, and steps of each in a round; episodes of the reference in a round."""

NUMBERS = count()
"""No graph is drawn twice."""


def test_side_by_side(benchmark: BenchmarkFixture) -> None:
    """One `GraphBatch`; each slot goes to random neighbours, and gets a fresh world as soon as an episode ends."""
    benchmark.group = f"{SLOTS * TURNS} steps of 16 nodes"
    rng, batch, slots = np.random.default_rng(0), GraphBatch(SLOTS), np.arange(SLOTS)
    renew(batch, slots)

    def play() -> None:
        for _ in range(TURNS):
            near = np.isfinite(batch.sense(slots).views[:, :, 0])  # [SLOTS, 16]
            chosen = (near * rng.random(near.shape, np.float32)).argmax(1)
            over = batch.step(slots, chosen).over
            if over.any():
                renew(batch, slots[over])

    play()  # compiles the kernels
    benchmark(play)


def test_reference(benchmark: BenchmarkFixture) -> None:
    """Whole episodes of `nearest_unvisited` on graphs of 1000 nodes."""
    benchmark.group = f"{EPISODES} episodes of 1000 nodes"

    def play() -> None:
        for _ in range(EPISODES):
            follow(fresh(LARGE, MANY, next(NUMBERS)))

    play()  # compiles the kernels
    benchmark(play)


def follow(world: GraphWorld) -> int:
    """Play an episode; its steps."""
    luck = np.random.default_rng(0)
    agent, state, over = NearestUnvisited().start(world.task, luck), world.reset(), False
    while not over:
        step = world.step(state, agent.act(world.sense(state, luck)), luck)
        state, over = step.state, step.reached or step.state.step >= world.task.budget.steps
    return state.step


def fresh(family: RandomGraph, conditions: GraphConditions, number: int) -> GraphWorld:
    """A world that nobody has played yet."""
    return family.sample(stream(0, "graphs", "map", number), number, conditions)


def renew(batch: GraphBatch, slots: Array) -> None:
    """Put fresh worlds into some slots."""
    numbers = [next(NUMBERS) for _ in slots]
    worlds: list[Any] = [fresh(GRAPHS, STEPS, number) for number in numbers]
    batch.reset(slots, worlds, [partial(stream, 0, "graphs", "luck", number) for number in numbers])
