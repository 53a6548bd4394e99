"""What knows which actions are right, by what an agent itself has seen. Each kind of world may name its own.

A class that `fogbench.planners.JUDGES` names is started with the task of an episode. It follows the agent's own known
map, and teaches: imitation learns its targets. If it also judges, decisions are counted as right or wrong. It may have
a classmethod `hindsight(world)`, which starts one that also knows the world, for training alone; and one,
`side_by_side(slots, hindsight=)`, which makes teachers of many episodes that are faster together (see `worlds.batch`).
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np

from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array, Observation, World


class Verdict(NamedTuple):
    """What is said of one decision."""

    judged: bool
    """Whether any action was right: without a way to the goal on the known map none is right or wrong."""
    wrong: bool
    """Whether no optimal plan on the known map begins with it."""
    strictly_wrong: bool
    """Whether the reference of the kind would decide otherwise on the same known map."""


NOT_JUDGED = Verdict(judged=False, wrong=False, strictly_wrong=False)


class Teacher(Protocol):
    """**Protocol:** follows one agent's known map and says what is right there."""

    def see(self, observation: Observation) -> None:
        """Take in what the agent is told; once for every observation, in order."""

    def targets(self) -> Any:
        """What imitation learns at the last observation.

        Where actions are few, [A] bool: which are right, in the order of the encoding's outputs; none where that is
        undefined.
        """


@runtime_checkable
class Judge(Teacher, Protocol):
    """**Protocol:** a teacher that also judges."""

    def judge(self, action: Any) -> Verdict:
        """The verdict on an action that was taken on the last observation."""


class Teachers(Protocol):
    """**Protocol:** teachers of episodes side by side; each slot has one at a time."""

    def reset(self, slots: Array, worlds: Sequence[Any]) -> None:
        """Put fresh teachers into some slots."""

    def see(self, slots: Array, observations: Any) -> None:
        """Take in what the agents there are told."""

    def targets(self, slots: Array) -> Array:
        """What imitation learns there: [n, A] bool."""


class TeacherByTeacher:
    """Teachers side by side, one after the other."""

    def __init__(self, slots: int, outputs: int, start: Callable[[Any], Teacher]) -> None:
        """Nobody yet; `start` makes the teacher of a world, which tells of so many outputs."""
        self.start, self.outputs = start, outputs
        self.teachers: list[Any] = [None] * slots

    def reset(self, slots: Array, worlds: Sequence[World]) -> None:
        """Put fresh teachers into some slots."""
        for slot, world in zip(slots.tolist(), worlds, strict=True):
            self.teachers[slot] = self.start(world)

    def see(self, slots: Array, observations: Sequence[Observation]) -> None:
        """Take in what the agents there are told."""
        for slot, observation in zip(slots.tolist(), observations, strict=True):
            self.teachers[slot].see(observation)

    def targets(self, slots: Array) -> Array:
        """What imitation learns there: [n, A] bool.

        Raises:
            Mistake: a teacher says something else.
        """
        told = [np.asarray(self.teachers[slot].targets()) for slot in slots.tolist()]
        for slot, targets in zip(slots.tolist(), told, strict=True):
            if targets.dtype != np.bool_ or targets.shape != (self.outputs,):
                got = f"got targets of {targets.dtype} {list(targets.shape)}; expected bool [{self.outputs}]"
                raise Mistake(f"{type(self.teachers[slot]).__name__}: {got}, one for each output.")
        return np.stack(told)
