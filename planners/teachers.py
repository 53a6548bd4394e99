"""Teachers of many episodes in one call, and how those of a judge that has none are kept side by side.

`fogbench.worlds.batch` says what a slot is.
"""

from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np

from fogbench.planners.judging import Teacher
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array, Observation, World


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
