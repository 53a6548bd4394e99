"""Random moves on fresh 16x16 maps, 40 steps at most: one world after the other, and 256 side by side.

Maps, resets and looks count. Each round of either form is as many steps.
"""

from functools import partial
from itertools import count
from typing import Any

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from fogbench.worlds.grid.batch import GridBatch
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.streams import stream
from fogbench.worlds.types import Array, Move

MAPS = Blobs(size=16, obstacles=(0, 12), obstacle_size=(1, 3))
WORDS = MAPS.words()
SLOTS, TURNS = 256, 40
"""Worlds side by side, and steps of each in a round."""

NUMBERS = count()
"""No map is drawn twice."""


@pytest.mark.parametrize("collision", ["blocked", "fails"])
def test_one_by_one(benchmark: BenchmarkFixture, collision: str) -> None:
    """The plain loop over `GridWorld`."""
    benchmark.group = f"{SLOTS * TURNS} steps of 16x16, {collision}"
    conditions, rng, moves = _conditions(collision), np.random.default_rng(0), tuple(Move)

    def play() -> None:
        steps = 0
        while steps < SLOTS * TURNS:
            world, over = _fresh(conditions, next(NUMBERS)), False
            state = world.reset()
            while not over:
                world.sense(state, rng)
                step = world.step(state, moves[int(rng.integers(4))], rng)
                state, steps = step.state, steps + 1
                over = step.reached or step.collided or state.step >= world.task.budget.steps

    play()  # compiles the kernels
    benchmark(play)


@pytest.mark.parametrize("collision", ["blocked", "fails"])
def test_side_by_side(benchmark: BenchmarkFixture, collision: str) -> None:
    """One `GridBatch`, each of whose slots gets a fresh world as soon as an episode ends."""
    benchmark.group = f"{SLOTS * TURNS} steps of 16x16, {collision}"
    conditions, rng, batch, slots = _conditions(collision), np.random.default_rng(0), GridBatch(SLOTS), np.arange(SLOTS)
    _renew(batch, slots, conditions)

    def play() -> None:
        for _ in range(TURNS):
            batch.sense(slots)
            over = batch.step(slots, rng.integers(4, size=SLOTS)).over
            if over.any():
                _renew(batch, slots[over], conditions)

    play()  # compiles the kernels
    benchmark(play)


def _conditions(collision: str) -> GridConditions:
    rules: dict[str, Any] = {"budget": {"steps": 40}, "rules": {"collision": collision}}
    return GridConditions.model_validate(rules)


def _fresh(conditions: GridConditions, number: int) -> GridWorld:
    world: Any = MAPS.sample(stream(0, WORDS, "map", number), number, conditions)
    return world  # type: ignore[no-any-return]


def _renew(batch: GridBatch, slots: Array, conditions: GridConditions) -> None:
    numbers = [next(NUMBERS) for _ in slots]
    worlds = [_fresh(conditions, number) for number in numbers]
    batch.reset(slots, worlds, [partial(stream, 0, WORDS, "luck", number) for number in numbers])
