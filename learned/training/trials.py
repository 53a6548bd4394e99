"""Worlds to learn on and to be tried on, and how a network does in those that were held out."""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import torch

from fogbench.learned.networks.network import Network
from fogbench.learned.training.recipe import Recipe, Worlds
from fogbench.learned.training.rollout import Drawn, greedy, roll_out
from fogbench.planners import JUDGES, judge_of
from fogbench.planners.judging import Teacher
from fogbench.planners.teachers import TeacherByTeacher, Teachers
from fogbench.worlds.batch import together
from fogbench.worlds.mistake import Mistake, one_of
from fogbench.worlds.streams import stream
from fogbench.worlds.tables import registered
from fogbench.worlds.types import MapFamily, World


def draw_world(worlds: Worlds, family: MapFamily, purpose: str, seed: int, number: int) -> Drawn:
    """The world of a number on a map of `family`, and the luck in it; another purpose shares nothing with them."""
    map_luck, luck = (
        partial(stream, seed, worlds.family.words(), f"{purpose} {what}", number) for what in ("map", "luck")
    )
    return Drawn(family.sample(map_luck(), number, worlds.conditions), luck)


def teachers_in(drawn: Sequence[Drawn], outputs: int, *, hindsight: bool = False) -> Teachers:
    """Who says which of so many outputs are right in some worlds, as `teacher_in` has it.

    Raises:
        Mistake: nobody knows for such a kind of world.
    """
    worlds = [world for world, _ in drawn]
    judge: Any = judge_of(worlds[0].task.kind)
    if together(*worlds) and "side_by_side" in vars(judge):
        made: Teachers = judge.side_by_side(len(worlds), hindsight=hindsight)
        return made
    return TeacherByTeacher(len(worlds), outputs, partial(teacher_in, hindsight=hindsight))


def teacher_in(world: World, *, hindsight: bool = False) -> Teacher:
    """Who says which outputs are right in a world, by what is known or, if any of them is, with hindsight.

    Raises:
        Mistake: nobody knows for such a kind of world.
    """
    kind = world.task.kind
    judge = judge_of(kind)
    if judge is None:
        kinds = one_of({**JUDGES, **registered("fogbench.judges")})
        raise Mistake(f"got worlds of kind {kind}, where nobody says which actions are right; expected {kinds}")
    if hindsight and not hasattr(judge, "hindsight"):
        raise Mistake(f"got hindsight in worlds of kind {kind}, whose judge has none; expected hindsight: false")
    teacher: Teacher = judge.hindsight(world) if hindsight else judge(world.task)
    return teacher


def refuse_unplayable(recipe: Recipe) -> None:
    """Draw a world of each lesson and variant, so that what cannot be played is told before the first batch.

    Raises:
        Mistake: there is no such world, the network does not fit it, or its tasks are a list, of which those to learn
            on, those to be tried on, and those that a scenario tests on are the same.
    """
    for place, worlds, family in recipe.places():
        try:
            listed = family.tasks(worlds.conditions, 1)
            world, _ = draw_world(worlds, family, "training", 0, 0)
            recipe.network.encoding().start(world.task)
        except Mistake as error:
            raise Mistake(error.within(f"{recipe.name}: {place}")) from None
        if listed is not None:
            told = "got a list of tasks; expected maps or tasks that are drawn afresh"
            raise Mistake(f"{recipe.name}: {place}: {told}.")


def validate(recipe: Recipe, network: Network) -> dict[str, dict[str, float]]:
    """How a network does in held-out episodes of each variant: success [%] and test error; nan where none is judged."""
    scores = {}
    for name, worlds in recipe.held_out.items():
        drawn = [
            draw_world(worlds, worlds.family, "validation", 0, number)  # the same for every seed
            for number in range(recipe.validation.episodes)
        ]
        judge = judge_of(drawn[0].world.task.kind)
        teachers = teachers_in(drawn, len(recipe.network.encoding().outputs)) if judge else None
        with torch.no_grad():
            rollout = roll_out(recipe.network, network, drawn, teachers, greedy)
        judged = int(rollout.judged.sum())
        wrong = int(rollout.wrong().sum()) / judged if judged else math.nan
        scores[name] = {"success": 100 * float(rollout.reached.mean()), "test_error": wrong}
    return scores
