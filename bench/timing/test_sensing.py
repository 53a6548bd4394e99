"""Seeing and remembering, once per step of every episode."""

from dataclasses import replace
from typing import cast

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from fogbench.worlds.conditions import BudgetSettings
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.rules import SquareView
from fogbench.worlds.grid.world import GridState, GridWorld
from fogbench.worlds.maps.cells import fuse
from fogbench.worlds.maps.families.blobs import Blobs

CONDITIONS = GridConditions(budget=BudgetSettings(steps=80))
RNG = np.random.default_rng(0)
WORLD = cast(GridWorld, Blobs(size=64, obstacles=(60, 140), obstacle_size=(1, 6)).sample(RNG, 0, CONDITIONS))
MIDDLE = GridState(0, (32, 32), blocked=False, witnessed=True)


@pytest.mark.parametrize("radius", [3, 10])
@pytest.mark.parametrize("occlusion", [False, True])
def test_sense(benchmark: BenchmarkFixture, radius: int, occlusion: bool) -> None:
    """One look from the middle of a 64x64 map, from the world's state to the observation."""
    benchmark.group = "sense"
    sensor = SquareView(radius=radius, occlusion=occlusion)
    benchmark(replace(WORLD, task=WORLD.task._replace(sensor=sensor)).sense, MIDDLE, RNG)


@pytest.mark.parametrize("radius", [3, 10])
def test_fuse(benchmark: BenchmarkFixture, radius: int) -> None:
    """One view written into the known map; every cell is compared, and after the first time none is new."""
    benchmark.group = "fuse"
    world = replace(WORLD, task=WORLD.task._replace(sensor=SquareView(radius=radius)))
    view = world.sense(MIDDLE, RNG).view
    benchmark(fuse, np.zeros((64, 64), np.uint8), view, *MIDDLE.place)
