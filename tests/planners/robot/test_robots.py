"""Whole episodes of every planner of robots, small and with unicycles."""

from pkgutil import resolve_name
from typing import Any

import numpy as np
import pytest

from fogbench.planners import PLANNERS
from fogbench.planners.robot.agent import points
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.types import Outcome, World

SETTINGS: dict[str, dict[str, Any]] = {
    "astar": {}, "dstar_lite": {}, "frontier": {}, "hfn": {}, "memoryless": {}, "rrt_star": {"iterations": 500},
}  # fmt: skip

HALLS = Blobs(size=100, obstacles=(15, 15), obstacle_size=(5, 15))


def world_of(seed: int, **blocks: Any) -> World:
    """A hall of 10 x 10 m."""
    rules = {"physics": "unicycle", **blocks.pop("rules", {})}
    tasks, budget = {"distance": (5, 30)}, {"steps": {"per_distance": 4, "plus": 40}}
    conditions = RobotConditions.model_validate({"tasks": tasks, "budget": budget, "rules": rules, **blocks})
    return HALLS.sample(np.random.default_rng(seed), seed, conditions)


def outcome(world: World, settings: Any, seed: int) -> Outcome:
    """How an episode ends."""
    agent, state, luck = (
        settings.start(world.task, np.random.default_rng(seed)),
        world.reset(),
        np.random.default_rng(seed),
    )
    for _ in range(world.task.budget.steps):
        action = agent.act(world.sense(state, luck))
        if action is None:
            return Outcome.GAVE_UP
        step = world.step(state, action, luck)
        if step.reached or step.collided:
            return Outcome.REACHED if step.reached else Outcome.COLLIDED
        state = step.state
    return Outcome.OUT_OF_STEPS


@pytest.mark.parametrize("name", SETTINGS)
def test_goals_are_reached_without_a_touch(name: str) -> None:
    """In ten halls nobody collides, and all but the one that forgets arrive nearly always."""
    settings = resolve_name(PLANNERS[name]).model_validate(SETTINGS[name])
    ends = [outcome(world_of(seed), settings, seed) for seed in range(10)]
    assert Outcome.COLLIDED not in ends
    assert ends.count(Outcome.REACHED) >= (6 if name == "memoryless" else 9)


def test_noise_is_borne() -> None:
    """Readings with 2 cm of noise and dropped beams, and a little drift."""
    settings = resolve_name(PLANNERS["astar"])()
    blocks = {"sensor": {"noise": 0.02, "dropped": 0.05}, "rules": {"collision": "blocked", "drift": 0.005}}
    ends = [outcome(world_of(seed, **blocks), settings, seed) for seed in range(10)]
    assert ends.count(Outcome.REACHED) >= 8


def test_points_end_at_the_goal() -> None:
    """The middles of cells in metres, and in the last cell the goal itself, wherever it lies in it."""
    task = world_of(0).task._replace(goal=(2.03, 1.98))
    path = np.array([19 * 100 + 18, 19 * 100 + 19, 19 * 100 + 20], np.int32)
    assert np.allclose(points(task, path), [(1.85, 1.95), (1.95, 1.95), (2.03, 1.98)])
