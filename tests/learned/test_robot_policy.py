"""Settings of networks on robots, and the paper's own size of one."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import torch
from pydantic import ValidationError

from fogbench import learned
from fogbench.bench.reading.recipe import read_recipe
from fogbench.learned.agent import MaskedAgent, PolicyAgent
from fogbench.learned.macn_robot import MacnRobot
from fogbench.learned.training.trials import draw_world
from fogbench.worlds.types import Waypoint, World

SMALL = MacnRobot(checkpoint="none", memory="lstm", features=16, hidden=16)

PAPER = Path(learned.__file__).with_name("recipes") / "macn-robot-paper.yaml"


def test_the_same_weights_play_both_rows(save: Callable[..., str]) -> None:
    """A mask is no part of a checkpoint; the image is."""
    place = save(SMALL, "robot")
    plain, masked = (MacnRobot.model_validate({"checkpoint": place, "masked": masked}) for masked in (False, True))
    world = _world()
    agents = [policy.start(world.task, np.random.default_rng(0)) for policy in (plain, masked)]
    assert [type(agent) for agent in agents] == [PolicyAgent, MaskedAgent]
    weights = [agent.network.state_dict() for agent in agents if isinstance(agent, PolicyAgent)]
    for name, tensor in weights[0].items():
        assert torch.equal(tensor, weights[1][name])
    with pytest.raises(ValidationError, match="window 10, with which the checkpoint was trained"):
        MacnRobot.model_validate({"checkpoint": place, "window": 9})


def test_the_size_of_the_paper_decides() -> None:
    """A map of 200x200, 40 iterations, a memory of 1024 rows of 512 with 4 read and 16 write heads, an LSTM of 512."""
    recipe = read_recipe(PAPER.read_text(), PAPER)
    policy = recipe.network
    assert isinstance(policy, MacnRobot)
    sizes = policy.plane, policy.iterations, policy.memory_rows, policy.word, policy.reads, policy.writes, policy.hidden
    assert sizes == ((200, 200), 40, 1024, 512, 4, 16, 512)
    world = _world()
    agent, luck = policy.start(world.task, np.random.default_rng(0)), np.random.default_rng(0)
    assert isinstance(agent.act(world.sense(world.reset(), luck)), Waypoint)
    assert agent.memory_bytes() > 4 * 1024 * (512 + 16 * 1024)


def _world() -> World:
    recipe = read_recipe(PAPER.read_text(), PAPER)
    worlds = recipe.lessons[0].worlds
    return draw_world(worlds, worlds.family, "training", 0, 0).world
