"""The contract of every reference, judge and encoding of the tables: one of each kind of world."""

from collections.abc import Callable, Iterator
from copy import deepcopy
from pkgutil import resolve_name
from typing import Any

import numpy as np
import pytest

from fogbench.learned import ENCODINGS
from fogbench.planners import JUDGES, REFERENCES, reference_of
from fogbench.planners.judging import Judge, Verdict
from fogbench.worlds import KINDS
from fogbench.worlds.types import World

Play = Callable[..., Iterator[Any]]

Arena = Callable[[str], list[World]]


def test_tables_name_kinds_that_there_are() -> None:
    """Nothing is kept for a kind of world that nobody can ask for."""
    assert {*REFERENCES, *JUDGES, *ENCODINGS} <= {*KINDS}


@pytest.mark.parametrize("kind", REFERENCES)
def test_a_reference_plays_its_kind_without_settings(kind: str, arena: Arena, play: Play) -> None:
    """It is started with its defaults, and decides in every world; its judge never finds it strictly wrong."""
    reference = reference_of(kind)
    assert reference is not None
    settings = resolve_name(reference.settings)()
    assert kind in settings.kinds
    for world in arena(kind):
        judge = resolve_name(JUDGES[kind])(world.task)
        for _, observation, action, _, _ in play(world, settings, 0):
            judge.see(observation)
            if action is not None:
                assert not judge.judge(action).strictly_wrong


@pytest.mark.parametrize("kind", JUDGES)
def test_a_judge_knows_what_it_teaches(kind: str, encoding: Any, arena: Arena, play: Play) -> None:
    """An output is right where it is a target; where there is none, nothing is judged."""
    made = resolve_name(JUDGES[kind])
    for world in arena(kind):
        judge = made(world.task)
        assert isinstance(judge, Judge)
        viewpoint = encoding.start(world.task)
        for _, observation, _, _, _ in play(world, resolve_name(REFERENCES[kind].settings)(), 0):
            judge.see(observation)
            viewpoint.see(observation)
            targets = judge.targets()
            assert targets.dtype == np.bool_
            assert targets.shape == (len(encoding.outputs),)
            for output, right in enumerate(targets):
                verdict = Verdict(*deepcopy(judge).judge(deepcopy(viewpoint).act(output)))
                assert verdict.judged == targets.any()
                assert verdict.wrong == (verdict.judged and not right)


@pytest.mark.parametrize("kind", JUDGES)
def test_hindsight_chooses_among_what_is_right(kind: str, arena: Arena, play: Play) -> None:
    """It asks for no action that is wrong by what is known, and for one wherever there is one."""
    made = resolve_name(JUDGES[kind])
    for world in arena(kind) if hasattr(made, "hindsight") else ():
        judge, hindsight = made(world.task), made.hindsight(world)
        for _, observation, _, _, _ in play(world, resolve_name(REFERENCES[kind].settings)(), 0):
            judge.see(observation)
            hindsight.see(observation)
            assert (hindsight.targets() <= judge.targets()).all()
            assert hindsight.targets().any() == judge.targets().any()


@pytest.mark.parametrize("kind", ENCODINGS)
def test_an_encoding_shows_many_as_it_shows_one(kind: str, encoding: Any, arena: Arena, play: Play) -> None:
    """A batch of viewpoints is encoded as each alone; outputs have names, all different, and one is open."""
    assert len(set(encoding.outputs)) == len(encoding.outputs)
    for world in arena(kind):
        viewpoints = [encoding.start(world.task) for _ in range(2)]
        for seed, viewpoint in enumerate(viewpoints):
            observation = next(play(world, resolve_name(REFERENCES[kind].settings)(), seed)).observation
            viewpoint.see(observation)
        both = encoding.encode(viewpoints)
        for row, viewpoint in enumerate(viewpoints):
            alone = encoding.encode([viewpoint])
            assert (alone.image[0] == both.image[row]).all()
            assert (encoding.open(alone)[0] == encoding.open(both)[row]).all()
            assert encoding.open(alone).shape == (1, len(encoding.outputs))
            assert viewpoint.bytes >= 0
