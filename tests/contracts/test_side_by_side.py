"""The contract of every kind of world, judge and encoding: side by side they are what they are one by one."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from fogbench.learned.encoding.viewpoints import ViewpointByViewpoint, viewpoints_of
from fogbench.planners import judge_of
from fogbench.planners.teachers import TeacherByTeacher
from fogbench.worlds.batch import WorldByWorld, batch_of, together
from fogbench.worlds.types import World

Arena = Callable[[str], list[World]]

Find = Callable[[str], Any]


@pytest.mark.parametrize("hindsight", [False, True])
def test_side_by_side_is_one_by_one(taught: str, encoding_of: Find, arena: Arena, hindsight: bool) -> None:
    """With random outputs all see, teach, encode and do the same, to the bit, until the last episode ends."""
    worlds, encoding, judge = arena(taught), encoding_of(taught), judge_of(taught)
    if hindsight and not hasattr(judge, "hindsight"):
        return
    outputs, slots = len(encoding.outputs), np.arange(len(worlds))
    start = judge.hindsight if hindsight else lambda world: judge(world.task)
    teachers: Any = TeacherByTeacher(len(worlds), outputs, start)
    if together(*worlds) and "side_by_side" in vars(judge):
        teachers = judge.side_by_side(len(worlds), hindsight=hindsight)
    many = batch_of(worlds), viewpoints_of(encoding, worlds), teachers
    single = (
        WorldByWorld(len(worlds)), ViewpointByViewpoint(len(worlds), encoding),
        TeacherByTeacher(len(worlds), outputs, start),
    )  # fmt: skip
    for batch, viewpoints, teaching in (many, single):
        batch.reset(slots, worlds, [partial(np.random.default_rng, k) for k in range(len(worlds))])
        viewpoints.reset(slots, [world.task for world in worlds])
        teaching.reset(slots, worlds)
    luck = np.random.default_rng(0)
    while len(slots):
        chosen = luck.integers(outputs, size=len(slots))
        one, other = (_turn(form, slots, chosen) for form in (many, single))
        for mine, theirs in zip(one, other, strict=True):
            assert np.array_equal(mine, theirs)
        slots = slots[~one[-1]]


def _turn(form: tuple[Any, Any, Any], slots: Any, chosen: Any) -> list[Any]:
    """One step of all episodes: what was seen, taught and encoded, and what came of it."""
    batch, viewpoints, teachers = form
    told = batch.sense(slots)
    viewpoints.see(slots, told)
    teachers.see(slots, told)
    seen = [part for observation in told for part in (observation.step, observation.place, observation.view)]
    inputs = viewpoints.encode(slots)
    steps = batch.step(slots, viewpoints.act(slots, chosen))
    return [*seen, teachers.targets(slots), *inputs, *steps, steps.over]
