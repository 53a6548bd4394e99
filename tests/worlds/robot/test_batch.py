"""Unicycles side by side, held against themselves one by one: decision by decision, bit for bit."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from fogbench.worlds.batch import WorldByWorld, batch_of
from fogbench.worlds.robot.batch import RobotBatch
from fogbench.worlds.robot.world import RobotWorld
from fogbench.worlds.types import Waypoint

Strew = Callable[..., RobotWorld]

BLOCKS: list[dict[str, Any]] = [
    {},
    {"sensor": {"beams": 60, "noise": 0.05, "dropped": 0.1}, "rules": {"collision": "blocked"}},
    {"walls": {"cell": 0.15}, "rules": {"drift": 0.05}, "body": {"radius": 0.25, "speed": 0.7}},
    {"body": {"decision": 0.1}, "sensor": {"field": 360.0, "range": 3.0}, "budget": {"steps": 30}},
]
"""Conditions of the slots."""


def luck_of(number: int) -> np.random.Generator:
    """The luck of an episode."""
    return np.random.default_rng(number)


def unicycle(strew: Strew, seed: int, blocks: dict[str, Any]) -> RobotWorld:
    """A world without MuJoCo."""
    return strew(seed, **{**blocks, "rules": {**blocks.get("rules", {}), "physics": "unicycle"}})


def test_a_batch_is_its_worlds(strew: Strew) -> None:
    """Whatever maps, bodies and lidars stand side by side, and whichever slots get other episodes."""
    worlds = [unicycle(strew, seed, BLOCKS[seed % 4]) for seed in range(8)]
    live, lucks = np.arange(8), [partial(luck_of, seed) for seed in range(8)]
    batch, single = batch_of(worlds), WorldByWorld(8)
    assert isinstance(batch, RobotBatch)
    for each in (batch, single):
        each.reset(live, worlds, lucks)
    rng, ended = luck_of(9), 0
    for turn in range(60):
        one, other = batch.sense(live), single.sense(live)
        for mine, theirs in zip(one, other, strict=True):
            assert mine._replace(view=0) == theirs._replace(view=0)
            assert np.array_equal(mine.view, theirs.view)
            assert not mine.view.flags.writeable
        ways = [Waypoint(*(rng.uniform(-1, 1, 3) + told.place).tolist()) for told in other]
        steps, expected = batch.step(live, ways), single.step(live, ways)
        for mine, theirs in zip(steps, expected, strict=True):
            assert np.array_equal(mine, theirs)
        for slot in live[steps.over].tolist():
            ended += 1
            fresh = unicycle(strew, 100 + turn, BLOCKS[(slot + turn) % 4])
            for each in (batch, single):
                each.reset(np.array([slot]), [fresh], [partial(luck_of, turn)])
    assert ended > 5


def test_a_body_of_mujoco_has_no_batch(strew: Strew) -> None:
    """It is played one by one."""
    assert isinstance(batch_of([strew(0)]), WorldByWorld)


@pytest.mark.parametrize("action", [(1.0, float("nan"), 0.0), (1.0, 2.0)])
def test_no_waypoint(strew: Strew, action: Any) -> None:
    """What is not three finite numbers is refused before anything moves."""
    world = unicycle(strew, 0, {})
    batch = batch_of([world])
    batch.reset(np.arange(1), [world], [partial(luck_of, 0)])
    with pytest.raises(TypeError, match="expected three finite numbers for each of 1"):
        batch.step(np.arange(1), [action])
    assert batch.sense(np.arange(1))[0].place == world.start
