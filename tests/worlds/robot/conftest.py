"""Small robot worlds, drawn as text or strewn at random."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fogbench.worlds.maps.layout import Layout
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.robot.world import RobotWorld
from fogbench.worlds.types import Array


def conditions_of(**blocks: Any) -> RobotConditions:
    """Conditions of their blocks, with a budget of 200 decisions."""
    return RobotConditions.model_validate({"budget": {"steps": 200}, **blocks})


def strewn(rng: np.random.Generator, side: int = 80, boxes: int = 12) -> Array:
    """[side, side] bool: a square with rectangles of 2 to 12 cells."""
    blocked = np.zeros((side, side), np.bool_)
    for _ in range(boxes):
        row, column, high, wide = *rng.integers(0, side, 2), *rng.integers(2, 13, 2)
        blocked[row : row + high, column : column + wide] = True
    return blocked


@pytest.fixture
def meet() -> Callable[..., RobotConditions]:
    """Makes conditions of their blocks."""
    return conditions_of


@pytest.fixture
def draw() -> Callable[..., RobotWorld]:
    """Makes a world of a text, each letter a metre (S start, G goal, # wall), and the blocks of its conditions."""

    def make(text: str, **blocks: Any) -> RobotWorld:
        letters = np.array([list(row) for row in text.split()])  # [h, w]
        ends = [tuple(np.argwhere(letters == letter)[0].tolist()) for letter in "SG"]
        conditions = conditions_of(**{"walls": {"cell": 1.0, "split": 10}, **blocks})
        world = conditions.world(Layout(letters == "#"), *ends)
        assert world is not None, conditions.wanted()
        return world

    return make


@pytest.fixture
def strew() -> Callable[..., RobotWorld]:
    """Makes a world of 8 x 8 m of a seed, with random rectangles, and the blocks of its conditions."""

    def make(seed: int, boxes: int = 12, **blocks: Any) -> RobotWorld:
        rng, conditions = np.random.default_rng(seed), conditions_of(**blocks)
        while True:
            blocked = strewn(rng, boxes=boxes)
            free = np.argwhere(~blocked)
            for _ in range(20):
                start, goal = (tuple(cell) for cell in rng.choice(free, 2).tolist())
                world = conditions.world(Layout(blocked), start, goal)
                if world is not None:
                    return world

    return make
