"""Teachers of graphs side by side, held against one judge for each."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from fogbench.planners.graph.judge import GraphJudge
from fogbench.planners.graph.teachers import GraphTeachers
from fogbench.worlds.batch import batch_of
from fogbench.worlds.graph.world import GraphWorld


@pytest.mark.parametrize("seed", range(12))
def test_teachers_tell_what_judges_tell(on: Callable[..., GraphWorld], weave: Callable[..., Any], seed: int) -> None:
    """Of graphs of several sizes, with lengths, coordinates and slips; a smaller one has none of the nodes beyond it.

    Slots are filled anew half-way, with larger graphs too.
    """
    rng = np.random.default_rng(seed)
    forms = ("unit", "lengths", "coordinates", "lengths")
    worlds = [fresh(on, weave, rng, form, most=12) for form in forms]
    batch, teachers, slots = batch_of(worlds), GraphJudge.side_by_side(4, hindsight=False), np.arange(4)
    assert isinstance(teachers, GraphTeachers)
    judges = put(batch, teachers, slots, worlds)
    for turn in range(16):
        if turn == 8:
            worlds[1:3] = [fresh(on, weave, rng, form, most=30) for form in forms[1:3]]
            judges[1:3] = put(batch, teachers, slots[1:3], worlds[1:3])
        told = batch.sense(slots)
        teachers.see(slots, told)
        for judge, observation, targets in zip(judges, told, teachers.targets(slots), strict=True):
            judge.see(observation)
            right = judge.targets()
            assert targets[: len(right)].tolist() == right.tolist()
            assert not targets[len(right) :].any()
        actions = [rng.choice(world.graph.row(seen.place)) for world, seen in zip(worlds, told, strict=True)]
        batch.step(slots, actions)


def fresh(on: Callable[..., GraphWorld], weave: Callable[..., Any], rng: Any, form: str, most: int) -> GraphWorld:
    """A world of a form, from its first node to its last."""
    source = weave(rng, form, most)
    return on(source, 0, len(source) - 1, slip=0.3)


def put(batch: Any, teachers: Any, slots: Any, worlds: list[GraphWorld]) -> list[GraphJudge]:
    """Begin episodes in some slots; the judges that follow them alone."""
    batch.reset(slots, worlds, [partial(np.random.default_rng, k) for k in range(len(worlds))])
    teachers.reset(slots, worlds)
    return [GraphJudge(world.task) for world in worlds]
