"""The contract of every reference, judge and encoding: one of each kind of world."""

from collections.abc import Callable, Iterator
from copy import deepcopy
from typing import Any

import numpy as np

from fogbench.learned import ENCODINGS
from fogbench.planners import JUDGES, REFERENCES, judge_of, reference_settings
from fogbench.planners.judging import Judge, Verdict
from fogbench.worlds import KINDS
from fogbench.worlds.types import World

Play = Callable[..., Iterator[Any]]

Arena = Callable[[str], list[World]]

Find = Callable[[str], Any]


def _reference(kind: str) -> Any:
    made = reference_settings(kind)
    assert made is not None
    return made()


def test_tables_name_kinds_that_there_are() -> None:
    """Nothing is kept for a kind of world that nobody can ask for."""
    assert {*REFERENCES, *JUDGES, *ENCODINGS} <= {*KINDS}


def test_a_reference_plays_its_kind_without_settings(refereed: str, arena: Arena, play: Play) -> None:
    """It is started with its defaults, and decides in every world; its judge never finds it strictly wrong."""
    settings = _reference(refereed)
    assert refereed in settings.kinds
    for world in arena(refereed):
        judge = judge_of(refereed)(world.task) if judge_of(refereed) else None
        for _, observation, action, _, _ in play(world, settings, 0):
            if not isinstance(judge, Judge):
                continue
            judge.see(observation)
            if action is not None:
                assert not judge.judge(action).strictly_wrong


def test_a_teacher_tells_of_each_output(taught: str, encoding_of: Find, arena: Arena, play: Play) -> None:
    """Which are right, wherever the reference decides; whoever only teaches has no verdict."""
    outputs = len(encoding_of(taught).outputs)
    for world in arena(taught):
        teacher = judge_of(taught)(world.task)
        assert isinstance(teacher, Judge) == (taught != "robot")
        for _, observation, action, _, _ in play(world, _reference(taught), 0):
            teacher.see(observation)
            targets = teacher.targets()
            assert targets.dtype == np.bool_
            assert targets.shape == (outputs,)
            assert targets.any() or action is None or isinstance(teacher, Judge)


def test_a_judge_knows_what_it_teaches(judged: str, encoding_of: Find, arena: Arena, play: Play) -> None:
    """An output is right where it is a target; where there is none, nothing is judged."""
    encoding = encoding_of(judged)
    for world in arena(judged):
        judge = judge_of(judged)(world.task)
        assert isinstance(judge, Judge)
        viewpoint = encoding.start(world.task)
        for _, observation, _, _, _ in play(world, _reference(judged), 0):
            judge.see(observation)
            viewpoint.see(observation)
            targets = judge.targets()
            assert targets.dtype == np.bool_
            assert targets.shape == (len(encoding.outputs),)
            for output, right in enumerate(targets):
                verdict = Verdict(*deepcopy(judge).judge(deepcopy(viewpoint).act(output)))
                assert verdict.judged == targets.any()
                assert verdict.wrong == (verdict.judged and not right)


def test_hindsight_chooses_among_what_is_right(judged: str, arena: Arena, play: Play) -> None:
    """It asks for no action that is wrong by what is known, and for one wherever there is one."""
    made = judge_of(judged)
    for world in arena(judged) if hasattr(made, "hindsight") else ():
        judge, hindsight = made(world.task), made.hindsight(world)
        for _, observation, _, _, _ in play(world, _reference(judged), 0):
            judge.see(observation)
            hindsight.see(observation)
            assert (hindsight.targets() <= judge.targets()).all()
            assert hindsight.targets().any() == judge.targets().any()


def test_an_encoding_shows_many_as_it_shows_one(shown: str, encoding_of: Find, arena: Arena, play: Play) -> None:
    """A batch of viewpoints is encoded as each alone; outputs have names, all different, and one is open."""
    encoding = encoding_of(shown)
    assert len(set(encoding.outputs)) == len(encoding.outputs)
    for world in arena(shown):
        viewpoints = [encoding.start(world.task) for _ in range(2)]
        for seed, viewpoint in enumerate(viewpoints):
            observation = next(play(world, _reference(shown), seed)).observation
            viewpoint.see(observation)
        both = encoding.encode(viewpoints)
        for row, viewpoint in enumerate(viewpoints):
            alone = encoding.encode([viewpoint])
            assert (alone.image[0] == both.image[row]).all()
            assert (encoding.open(alone)[0] == encoding.open(both)[row]).all()
            assert encoding.open(alone).shape == (1, len(encoding.outputs))
            assert viewpoint.bytes >= 0
