"""What imitation learns of robots."""

from math import dist, pi
from typing import Any

import numpy as np
import pytest

from fogbench.planners import judge_of
from fogbench.planners.astar import AStar
from fogbench.planners.judging import Judge
from fogbench.planners.robot.choices import CHOICES, NAMES, TURNS
from fogbench.planners.robot.pilot import PATIENCE
from fogbench.planners.robot.teacher import RobotTeacher
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.robot.world import RobotWorld
from fogbench.worlds.types import Observation, Waypoint

UNICYCLE = {"rules": {"physics": "unicycle"}, "sensor": {"beams": 90}, "budget": {"steps": 90}}


def drawn(seed: int) -> RobotWorld:
    """A world of 9 x 9 m with rectangles."""
    family, conditions = Blobs(size=90, obstacles=(8, 14), obstacle_size=(3, 12)), RobotConditions(**UNICYCLE)
    world: Any = family.sample(np.random.default_rng(seed), 0, conditions)
    return world


def names(teacher: RobotTeacher) -> set[str]:
    """The choices that are right."""
    return {NAMES[k] for k in np.flatnonzero(teacher.targets()).tolist()}


def test_it_teaches_and_does_not_judge() -> None:
    """It is found by the kind of world."""
    assert judge_of("robot") is RobotTeacher
    assert not isinstance(RobotTeacher(drawn(0).task), Judge)


@pytest.mark.parametrize("seed", range(4))
def test_the_places_around_its_waypoint_are_right(seed: int) -> None:
    """It decides as A* does that drives itself; right places lie within a cell of the grid around its waypoint."""
    world, luck = drawn(seed), np.random.default_rng(0)
    teacher, agent = RobotTeacher(world.task), AStar().start(world.task, luck)
    state, near = world.reset(), []
    for _ in range(60):
        observation = world.sense(state, luck)
        teacher.see(observation)
        action: Any = agent.act(observation)
        x, y, heading = observation.place
        right = CHOICES[teacher.targets()]
        assert 1 <= len(right) <= 4
        cos, sin = np.cos(heading), np.sin(heading)
        points = np.stack([x + right[:, 0] * cos - right[:, 1] * sin, y + right[:, 0] * sin + right[:, 1] * cos], -1)
        near.append(max(dist(point, action[:2]) for point in points.tolist()) < 0.29)
        step = world.step(state, action, luck)
        if step.reached:
            break
        state = step.state
    assert step.reached
    assert np.mean(near) > 0.9


def seen(teacher: RobotTeacher, waypoint: tuple[float, float, float] | None) -> RobotTeacher:
    """The teacher, as if it stood at (4.5, 4.5) with heading 0 in the open and would send a waypoint."""
    teacher.place, teacher.speeds = (4.5, 4.5, 0.0), (0.0, 0.0)
    teacher.waypoint = waypoint and Waypoint(4.5 + waypoint[0], 4.5 + waypoint[1], waypoint[2])
    return teacher


def test_targets_by_hand() -> None:
    """The four corners around a point, fewer beside the robot; the two turns around a heading; none without a path."""
    teacher = RobotTeacher(drawn(0).task)
    ahead = {f"{x} m ahead, {y} m left" for x in ("0.8", "1") for y in ("0", "0.2")}
    assert names(seen(teacher, (0.9, 0.1, 0.0))) == ahead
    assert names(seen(teacher, (1.0, 0.1, 0.0))) == ahead
    beside = {"0 m ahead, 0.2 m left", "0.2 m ahead, 0 m left", "0.2 m ahead, 0.2 m left"}
    assert names(seen(teacher, (0.1, 0.1, 0.0))) == beside
    assert names(seen(teacher, (0.0, 0.0, 0.1))) == {"turn by 0 degrees", "turn by 45 degrees"}
    assert names(seen(teacher, (0.0, 0.0, -0.1))) == {"turn by 315 degrees", "turn by 0 degrees"}
    assert "turn by 0 degrees" in names(seen(teacher, (0.0, 0.0, -1e-17)))
    assert names(seen(teacher, None)) == set()
    assert len(CHOICES) - TURNS == 120


def test_of_places_around_those_count_that_are_safe() -> None:
    """Beside a wall that is known; where none is safe, all do."""
    teacher = RobotTeacher(drawn(0).task)
    teacher.agent.known.cells[:] = 1
    teacher.agent.known.cells[47:60, 50:60] = 2  # from 4.7 m on, so the way straight ahead has 10 cm to spare
    seen(teacher, (0.9, -0.1, 0.0))
    assert names(teacher) == {"0.8 m ahead, -0.2 m left", "1 m ahead, -0.2 m left"}
    teacher.agent.known.cells[30:60, 48:60] = 2
    assert len(names(seen(teacher, (0.9, -0.1, 0.0)))) == 4


def test_who_turns_is_not_stuck() -> None:
    """The pilot makes room for a robot that stays as it is, and not for one that looks around."""
    still, turning = RobotTeacher(drawn(0).task), RobotTeacher(drawn(0).task)
    view = np.full(90, 5.0, np.float32)
    for step in range(8):
        still.see(Observation(step, (4.5, 4.5, 0.0), view, False))
        turning.see(Observation(step, (4.5, 4.5, 0.5 * (step % 2)), view, False))
    assert still.agent.pilot.stayed > PATIENCE
    assert turning.agent.pilot.stayed <= 1


def test_speeds_follow_from_poses() -> None:
    """A change at an even rate leaves twice the mean, less what was before; who was stopped stands."""
    teacher, view = RobotTeacher(drawn(0).task), np.full(90, 5.0, np.float32)
    teacher.see(Observation(0, (4.5, 4.5, 0.0), view, False))
    teacher.see(Observation(1, (4.75, 4.5, 0.0), view, False))
    assert teacher.speeds == pytest.approx((1.0, 0.0))
    teacher.see(Observation(2, (5.25, 4.5, -pi / 8), view, False))
    assert teacher.speeds == pytest.approx((1.0, -pi / 2))
    teacher.see(Observation(3, (5.25, 4.5, 0.0), view, True))
    assert teacher.speeds == (0.0, 0.0)
