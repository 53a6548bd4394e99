"""Viewpoints of many episodes in one call, and how those of an encoding that has none are kept side by side.

`fogbench.worlds.batch` says what a slot is.
"""

from collections.abc import Sequence
from typing import Any, Protocol

from fogbench.learned.encoding.encoding import Encoding
from fogbench.worlds.batch import together
from fogbench.worlds.types import Array, Observation, Task, World


class Viewpoints(Protocol):
    """**Protocol:** viewpoints of episodes side by side; each slot has one at a time."""

    def reset(self, slots: Array, tasks: Sequence[Task]) -> None:
        """Put fresh viewpoints into some slots.

        Raises:
            Mistake: as `Encoding.start`.
        """

    def see(self, slots: Array, observations: Any) -> None:
        """Take in what the agents there are told."""

    def encode(self, slots: Array) -> Any:
        """What a network sees from there, as `Encoding.encode` has it."""

    def act(self, slots: Array, outputs: Array) -> Sequence[Any]:
        """The actions that outputs of the network mean there."""


class ViewpointByViewpoint:
    """Viewpoints side by side, one after the other."""

    def __init__(self, slots: int, encoding: Encoding) -> None:
        """Nobody yet."""
        self.encoding = encoding
        self.viewpoints: list[Any] = [None] * slots

    def reset(self, slots: Array, tasks: Sequence[Task]) -> None:
        """Put fresh viewpoints into some slots."""
        for slot, task in zip(slots.tolist(), tasks, strict=True):
            self.viewpoints[slot] = self.encoding.start(task)

    def see(self, slots: Array, observations: Sequence[Observation]) -> None:
        """Take in what the agents there are told."""
        for slot, observation in zip(slots.tolist(), observations, strict=True):
            self.viewpoints[slot].see(observation)

    def encode(self, slots: Array) -> Any:
        """What a network sees from there."""
        return self.encoding.encode([self.viewpoints[slot] for slot in slots.tolist()])

    def act(self, slots: Array, outputs: Array) -> list[Any]:
        """The actions that outputs of the network mean there."""
        pairs = zip(slots.tolist(), outputs.tolist(), strict=True)
        return [self.viewpoints[slot].act(output) for slot, output in pairs]


def viewpoints_of(encoding: Any, worlds: Sequence[World]) -> Viewpoints:
    """Viewpoints with a slot for each of some worlds."""
    made: Viewpoints = ViewpointByViewpoint(len(worlds), encoding)
    if together(encoding, *worlds):
        made = encoding.side_by_side(len(worlds))
    return made
