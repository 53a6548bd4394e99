"""The contract of every map family of the table."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from fogbench.worlds import FAMILIES, KINDS
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.covariates import COVARIATES
from fogbench.worlds.types import MapError, MapFamily

Conditions = Callable[..., Any]

UNDER = ({"steps": 40}, {"steps": {"per_distance": 3, "plus": 5}, "distance": (4, 20), "radius": 2, "occlusion": True})
"""Fields of the conditions that families are tested under."""


def sampled(family: MapFamily, conditions: Conditions, count: int = 8) -> list[GridWorld]:
    """The first few worlds of a family, under each of the conditions."""
    return [
        family.sample(np.random.default_rng([seed, 7]), seed, conditions(**fields))
        for fields in UNDER
        for seed in range(count)
    ]


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


def test_the_kinds_exist(family: MapFamily) -> None:
    """A family makes worlds of kinds that there are, of one at least."""
    assert family.kinds
    assert set(family.kinds) <= set(KINDS)


def test_worlds_keep_the_protocol(family: MapFamily, conditions: Conditions) -> None:
    """A task says what the conditions say; start and goal are apart, free, and on the map."""
    for world in sampled(family, conditions):
        task = world.task
        assert (task.kind, task.extent) == (family.kinds[0], world.blocked.shape)
        assert family.extent() in (None, task.extent)
        assert (world.reset().place, task.goal) == (world.start, task.goal)
        assert world.start != task.goal
        for cell in (world.start, task.goal):
            assert [type(number) for number in cell] == [int, int]
            assert all(0 <= number < side for number, side in zip(cell, world.blocked.shape, strict=True))
            assert not world.blocked[cell]
    under = conditions(**UNDER[1])
    assert task.sensor == under.sensor
    assert world.rules == under.rules
    assert task.budget == under.budget.over(world.straight())


def test_optima_are_right_and_inside_the_bounds(family: MapFamily, conditions: Conditions) -> None:
    """The full-map optimum is scipy's, and is in `tasks.distance`, or in the step budget where that is not given."""
    for world in sampled(family, conditions):
        assert world.shortest() == independent(world)
        assert world.straight() <= world.shortest()
    for world in sampled(family, conditions)[:8]:
        assert 1 <= world.shortest() <= 40
    for world in sampled(family, conditions)[8:]:
        assert 4 <= world.shortest() <= 20


def test_covariates_are_in_range(family: MapFamily, conditions: Conditions) -> None:
    """All four, in their order, where they can be."""
    for world in sampled(family, conditions):
        covariates = world.covariates()
        assert tuple(covariates) == COVARIATES
        assert all(type(value) is float for value in covariates.values())
        assert 0 <= covariates["density"] < 1
        assert covariates["detour"] == world.shortest() / world.straight() >= 1
        assert 0 <= covariates["dead_ends"] <= 100
        assert 0 <= covariates["openness"] <= 1


def test_maps_are_read_only(family: MapFamily, conditions: Conditions) -> None:
    """Nobody can write into a map, which all episodes in the same world share."""
    for world in sampled(family, conditions, 2):
        assert world.blocked.dtype == np.bool_
        with pytest.raises(ValueError, match="read-only"):
            world.blocked[world.start] = True


def test_sampling_repeats(family: MapFamily, conditions: Conditions) -> None:
    """The same generator and number give the same world; other episodes are other worlds."""
    first, again = sampled(family, conditions), sampled(family, conditions)
    for a, b in zip(first, again, strict=True):
        assert np.array_equal(a.blocked, b.blocked)
        assert (a.start, a.task, a.optimum, a.posts) == (b.start, b.task, b.optimum, b.posts)
    assert len({(world.blocked.tobytes(), world.start, world.task.goal) for world in first}) > 4


def test_a_list_of_tasks_ends(family: MapFamily, conditions: Conditions) -> None:
    """A family says how many episodes it has: its last can be drawn, and the one after it is an error of one line."""
    under = conditions(steps=40)
    count = family.tasks(under)
    if count is None:
        count = 10**6
        family.sample(np.random.default_rng(0), count, under)
        return
    family.sample(np.random.default_rng(0), count - 1, under)
    with pytest.raises(MapError, match=f"expected at most {count} episodes") as caught:
        family.sample(np.random.default_rng(0), count, under)
    assert "\n" not in str(caught.value)


def test_words_repeat(family: MapFamily) -> None:
    """The words of equal settings are equal."""
    again = type(family).model_validate_json(family.model_dump_json())
    assert again.words() == family.words()


@pytest.mark.parametrize("name", FAMILIES)
def test_words_tell_settings_apart(name: str, examples: Callable[[str], list[Any]]) -> None:
    """Different settings, and different files, have different words."""
    words = [family.words() for family in examples(name)]
    assert len(words) > 1
    assert len(set(words)) == len(words)
