"""Many episodes in one call: what a batch of worlds is, and one for worlds that come without.

Words used here
    slots     [n] int64, which episodes a call is about, in rising order; each place of a batch holds one at a time
    n         how many they are

A class of worlds that is faster together has a classmethod `side_by_side(slots)`, which makes a batch with so many
slots. A subclass inherits none, since it may play by other rules.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np

from fogbench.worlds.types import Array, Observation, World

Luck = Callable[[], np.random.Generator]
"""Makes the generator of the sensor and of slips in one episode; who needs no luck does not ask."""


class Steps(NamedTuple):
    """What one action of each of n episodes did; see `Step`."""

    lengths: Array
    """[n] float64"""
    collided: Array
    """[n] bool"""
    reached: Array
    """[n] bool"""
    spent: Array
    """[n] bool, whether the step budget is used up."""

    @property
    def over(self) -> Array:
        """[n] bool, whether the episode has ended."""
        ended: Array = self.collided | self.reached | self.spent
        return ended


class Batch(Protocol):
    """**Protocol:** episodes side by side, each as `World` has it alone, bit for bit."""

    def reset(self, slots: Array, worlds: Sequence[Any], lucks: Sequence[Luck]) -> None:
        """Put fresh episodes into some slots."""

    def sense(self, slots: Array) -> Sequence[Observation]:
        """What the agents there are told."""

    def step(self, slots: Array, actions: Sequence[Any] | Array) -> Steps:
        """The effects of their actions.

        Raises:
            TypeError: something is not an action of this kind of world.
        """


class WorldByWorld:
    """A batch of any worlds, one after the other."""

    def __init__(self, slots: int) -> None:
        """No episode yet."""
        nobody: Any = None
        self.worlds: list[World] = [nobody] * slots
        self.lucks: list[np.random.Generator] = [nobody] * slots
        self.states: list[Any] = [nobody] * slots
        self.steps = np.zeros(slots, np.int64)

    def reset(self, slots: Array, worlds: Sequence[World], lucks: Sequence[Luck]) -> None:
        """Put fresh episodes into some slots."""
        for slot, world, luck in zip(slots.tolist(), worlds, lucks, strict=True):
            self.worlds[slot], self.lucks[slot], self.states[slot] = world, luck(), world.reset()
        self.steps[slots] = 0

    def sense(self, slots: Array) -> list[Observation]:
        """What the agents there are told."""
        return [self.worlds[slot].sense(self.states[slot], self.lucks[slot]) for slot in slots.tolist()]

    def step(self, slots: Array, actions: Sequence[Any] | Array) -> Steps:
        """The effects of their actions."""
        done = [
            self.worlds[slot].step(self.states[slot], action, self.lucks[slot])
            for slot, action in zip(slots.tolist(), actions, strict=True)
        ]
        for slot, step in zip(slots.tolist(), done, strict=True):
            self.states[slot] = step.state
        self.steps[slots] += 1
        budgets = np.array([self.worlds[slot].task.budget.steps for slot in slots.tolist()], np.int64)
        lengths = np.array([step.length for step in done], np.float64)
        collided, reached = (np.array([step[k] for step in done], np.bool_) for k in (2, 3))
        return Steps(lengths, collided, reached, self.steps[slots] >= budgets)


def together(*things: object) -> bool:
    """Whether all of some things are of classes that have a `side_by_side` of their own."""
    return all("side_by_side" in vars(kind) for kind in {type(thing) for thing in things})


def batch_of(worlds: Sequence[World]) -> Batch:
    """A batch with a slot for each of some worlds."""
    kinds: set[Any] = {type(world) for world in worlds}
    if len(kinds) > 1 or not together(*worlds):
        return WorldByWorld(len(worlds))
    made: Batch = kinds.pop().side_by_side(len(worlds))
    return made
