"""The contract of every map family that draws cells."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from fogbench.worlds.grid.rules import GridRules, SquareView
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.types import MapFamily

Sample = Callable[..., list[Any]]


def independent(world: GridWorld) -> float:
    """The length of the optimum, by scipy."""
    height, width = world.blocked.shape
    flat = np.arange(height * width).reshape(height, width)  # [H, W]
    free = ~world.blocked
    down, right = free[:-1] & free[1:], free[:, :-1] & free[:, 1:]
    a = np.concatenate([flat[:-1][down], flat[:, :-1][right]])  # [edges]
    b = np.concatenate([flat[1:][down], flat[:, 1:][right]])  # [edges]
    graph = coo_array((np.ones(len(a)), (a, b)), shape=(flat.size, flat.size))
    lengths = dijkstra(graph.tocsr(), directed=False, indices=flat[world.start], unweighted=True)  # [H * W]
    return float(lengths[flat[world.task.goal]])


def test_start_and_goal_are_free_cells(grid_family: MapFamily, sampled: Sample) -> None:
    """They are on the map, whose size the task tells."""
    for world in sampled(grid_family):
        task = world.task
        assert task.extent == world.blocked.shape
        assert world.reset().place == world.start
        for cell in (world.start, task.goal):
            assert [type(number) for number in cell] == [int, int]
            assert all(0 <= number < side for number, side in zip(cell, world.blocked.shape, strict=True))
            assert not world.blocked[cell]


def test_sensor_and_rules_are_those_of_the_conditions(grid_family: MapFamily, sampled: Sample) -> None:
    """The defaults, and what the second half is drawn under."""
    for number, world in enumerate(sampled(grid_family)):
        plain = number < 8
        assert world.task.sensor == (SquareView() if plain else SquareView(radius=2, occlusion=True))
        assert world.rules == (GridRules() if plain else GridRules(collision="blocked"))


def test_optima_are_right(grid_family: MapFamily, sampled: Sample) -> None:
    """The full-map optimum is scipy's."""
    for world in sampled(grid_family):
        assert world.shortest() == independent(world)


def test_covariates_are_in_range(grid_family: MapFamily, sampled: Sample) -> None:
    """Each where it can be."""
    for world in sampled(grid_family):
        covariates = world.covariates()
        assert 0 <= covariates["density"] < 1
        assert covariates["detour"] == world.shortest() / world.straight() >= 1
        assert 0 <= covariates["dead_ends"] <= 100
        assert 0 <= covariates["openness"] <= 1


def test_maps_are_read_only(grid_family: MapFamily, sampled: Sample) -> None:
    """Nobody can write into a map, which all episodes in the same world share."""
    for world in sampled(grid_family):
        assert world.blocked.dtype == np.bool_
        with pytest.raises(ValueError, match="read-only"):
            world.blocked[world.start] = True
