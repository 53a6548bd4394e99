"""The contract of every map family, whatever the kind of its worlds."""

import pickle
from collections.abc import Callable
from pkgutil import resolve_name
from typing import Any

import numpy as np
import pytest

from fogbench.worlds import KINDS
from fogbench.worlds.tables import named
from fogbench.worlds.types import MapError, MapFamily, World

Sample = Callable[[MapFamily], list[World]]

Under = Callable[..., Any]


def test_kinds_exist(family: MapFamily) -> None:
    """A family makes worlds of kinds that there are, of one at least."""
    assert family.kinds
    assert all(named(KINDS, "fogbench.kinds", kind) for kind in family.kinds)


def test_tasks_say_what_the_conditions_say(family: MapFamily, sampled: Sample, under: Under) -> None:
    """The kind, the size, and a budget over the straight distance; start and goal are apart."""
    terms = under(family.kinds[0], steps={"per_distance": 3, "plus": 5})
    for number, world in enumerate(sampled(family)):
        task = world.task
        assert task.kind == family.kinds[0]
        assert family.extent() in (None, task.extent)
        assert task.budget == (under(family.kinds[0]) if number < 8 else terms).budget.over(world.straight())
        assert world.reset().place != task.goal
        assert world.remaining(world.reset()) == world.shortest() > 0


def test_optima_are_inside_the_bounds(family: MapFamily, sampled: Sample) -> None:
    """In `tasks.distance`, or in the step budget where that is not given."""
    worlds = sampled(family)
    assert all(world.straight() <= world.shortest() for world in worlds)
    assert all(1 <= world.shortest() <= 40 for world in worlds[:8])
    assert all(4 <= world.shortest() <= 20 for world in worlds[8:])


def test_covariates_are_those_of_the_kind(family: MapFamily, sampled: Sample) -> None:
    """All that the conditions promise, in their order, each a finite number."""
    promised = resolve_name(named(KINDS, "fogbench.kinds", family.kinds[0]).conditions).covariates
    for world in sampled(family):
        covariates = world.covariates()
        assert tuple(covariates) == promised
        assert all(type(value) is float and np.isfinite(value) for value in covariates.values())


def test_sampling_repeats(family: MapFamily, sampled: Sample) -> None:
    """The same generator and number give the same world; other episodes are other worlds."""
    first, again = ([pickle.dumps(world) for world in sampled(family)] for _ in range(2))
    assert first == again
    assert len(set(first)) > 4


def test_a_list_of_tasks_ends(family: MapFamily, under: Under) -> None:
    """A family counts its episodes as far as it is asked: its last can be drawn, the one after it is an error."""
    conditions = under(family.kinds[0])
    count = family.tasks(conditions, 10**6)
    if count is None:
        count = 10**6
        family.sample(np.random.default_rng(0), count, conditions)
        return
    family.sample(np.random.default_rng(0), count - 1, conditions)
    assert [family.tasks(conditions, most) for most in (1, count - 1, count)] == [1, count - 1, count]
    with pytest.raises(MapError, match=f"{count} of [0-9]+ tasks|{count} tasks") as caught:
        family.sample(np.random.default_rng(0), count, conditions)
    assert "\n" not in str(caught.value)


def test_words_repeat(family: MapFamily) -> None:
    """The words of equal settings are equal."""
    again = type(family).model_validate_json(family.model_dump_json())
    assert again.words() == family.words()


def test_words_tell_settings_apart(family_name: str, examples: Callable[[str], list[Any]]) -> None:
    """Different settings, and different files, have different words."""
    words = [family.words() for family in examples(family_name)]
    assert len(words) > 1
    assert len(set(words)) == len(words)
