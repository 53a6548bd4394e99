"""The controller, the unicycle, and MuJoCo's body that follows both."""

from collections.abc import Callable
from itertools import pairwise
from math import dist, hypot, pi, remainder
from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fogbench.worlds.robot.driving import aim, carried, command, move, wrapped
from fogbench.worlds.robot.rules import TICK, Body
from fogbench.worlds.robot.simulation import Simulation
from fogbench.worlds.robot.unicycle import drive
from fogbench.worlds.robot.world import RobotWorld, simulation
from fogbench.worlds.types import FREE, Waypoint

Strew = Callable[..., RobotWorld]

ANGLES = st.floats(-3.1, 3.1)
POSES = st.tuples(st.floats(-3, 3), st.floats(-3, 3), ANGLES)
BODY = Body()
HALL = np.full((200, 200), FREE, np.uint8)
NOWHERE = (0.0, 0.0)


@given(pose=POSES, waypoint=POSES, v=st.floats(0, 1), w=st.floats(-2, 2))
def test_commands_keep_the_limits(pose: Any, waypoint: Any, v: float, w: float) -> None:
    """No speed is above its limit, none changes faster than it may, and nobody drives backwards."""
    new_v, new_w = command(pose, v, w, waypoint, BODY.limits)
    assert -1e-9 <= new_v <= 1 + 1e-9
    assert abs(new_w) <= 2 + 1e-9
    assert abs(new_v - v) <= 2 * TICK + 1e-9
    assert abs(new_w - w) <= 8 * TICK + 1e-9


@given(waypoint=POSES)
def test_a_waypoint_is_reached(waypoint: Any) -> None:
    """From standing still, with its heading, and the unicycle then stands."""
    pose, v, w = (0.0, 0.0, 0.0), 0.0, 0.0
    for _ in range(round(20 / TICK)):
        v, w = command(pose, v, w, waypoint, BODY.limits)
        pose = move(pose, v, w)
    assert dist(pose[:2], waypoint[:2]) < 0.03
    assert abs(remainder(pose[2] - waypoint[2], 2 * pi)) < 0.01
    assert abs(v) + abs(w) < 0.01


@given(waypoint=st.tuples(st.floats(-3, -0.1), st.floats(-1, 1), ANGLES))
def test_what_lies_behind_is_turned_to_in_place(waypoint: Any) -> None:
    """A body that rolls brakes straight before; standing, it turns on the spot."""
    pose, v, w = (0.0, 0.0, 0.0), 1.0, 0.0
    while v > 0.05:
        v, w = command(pose, v, w, waypoint, BODY.limits)
        assert w == 0
    v, w = command((0.0, 0.0, 0.0), 0.0, 0.0, waypoint, BODY.limits)
    assert v == 0
    assert w != 0


@given(pose=POSES, here=POSES, there=POSES)
def test_poses_are_carried_and_carried_back(pose: Any, here: Any, there: Any) -> None:
    """Distances stay; the pose itself becomes the other."""
    moved = carried(pose, here, there)
    assert dist(moved[:2], there[:2]) == pytest.approx(dist(pose[:2], here[:2]), abs=1e-9)
    assert carried(here, here, there) == pytest.approx((*there[:2], wrapped(there[2])), abs=1e-9)
    assert carried(moved, there, here)[:2] == pytest.approx(pose[:2], abs=1e-9)


def test_a_far_waypoint_is_drawn_in() -> None:
    """To the stride, on the straight way; a near one stays."""
    assert aim((4.0, 3.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0) == pytest.approx((0.8, 0.6, 1.0))
    assert aim((0.4, 0.3, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0) == pytest.approx((0.4, 0.3, 1.0))


@pytest.mark.parametrize("radius", [0.1, 0.2, 0.5])
@pytest.mark.parametrize(("v", "w"), [(1.0, 0.0), (0.5, 0.0), (0.0, 2.0), (0.0, 0.5), (1.0, 0.8), (0.5, -1.0)])
def test_the_body_follows_its_commands(radius: float, v: float, w: float) -> None:
    """Once it is up to speed, within one percent."""
    sim = Simulation(HALL, 0.1, Body(radius=radius))
    sim.start((10.0, 10.0, 0.0))
    poses = []
    for tick in range(150):
        sim._tick(v * min(1, tick / 25), w * min(1, tick / 25))
        poses.append(sim.pose())
    driven = sum(dist(a[:2], b[:2]) for a, b in pairwise(poses[50:]))
    turned = np.unwrap([pose[2] for pose in poses[50:]])
    seconds = TICK * (len(poses) - 51)
    assert driven / seconds == pytest.approx(v, rel=0.01, abs=0.001)
    assert (turned[-1] - turned[0]) / seconds == pytest.approx(w, rel=0.01, abs=0.001)


def test_the_unicycle_ends_where_the_body_does() -> None:
    """After each of 5000 decisions: within a centimetre at the 95th percentile."""
    sim, rng, apart = Simulation(HALL, 0.1, BODY), np.random.default_rng(0), []
    state, pose, v, w = sim.start((10.0, 10.0, 0.0)), (10.0, 10.0, 0.0), 0.0, 0.0
    for _ in range(5000):
        far, angle, heading = rng.uniform((0, -pi, -pi), (1, pi, pi)).tolist()
        middle = hypot(pose[0] - 10, pose[1] - 10) > 6
        waypoint = (
            (10.0, 10.0, 0.0) if middle else (pose[0] + far * np.cos(angle), pose[1] + far * np.sin(angle), heading)
        )
        waypoint = aim(waypoint, pose, pose, 1.0)
        done = sim.drive(state, v, w, waypoint, NOWHERE, 0.0, on=False)
        own = drive(HALL, 0.1, 0.2, pose, v, w, waypoint, BODY.limits, BODY.ticks, NOWHERE, 0.0)
        apart.append(dist(done.pose[:2], own[0][:2]))
        state, pose, v, w = sim.state(), done.pose, done.v, done.w
    assert np.quantile(apart, 0.95) < 0.01


def test_both_touch_the_same_walls(strew: Strew) -> None:
    """Random decisions beside walls: a touch of one is a touch of the other, but for few that barely do."""
    same = []
    for seed in range(10):
        world, rng = strew(seed, rules={"collision": "blocked"}), np.random.default_rng(seed)
        state = world.reset()
        for _ in range(30):
            waypoint = Waypoint(*(np.array(state.place) + rng.uniform(-1, 1, 3)).tolist())
            aimed, body = aim(tuple(waypoint), state.place, state.place, 1.0), world.task.sensor.body
            own = drive(
                world.cells, 0.1, body.radius, state.place, state.v, state.w,
                aimed, body.limits, body.ticks, world.task.goal, 0.3,
            )  # fmt: skip
            state = world.step(state, waypoint, rng).state
            same.append(own[4] == state.blocked)
            if state.blocked:
                state = world.reset()
    assert np.mean(same) > 0.97


def test_random_actions_never_leave_the_walls(strew: Strew) -> None:
    """A thousand sequences, 400,000 steps: all is finite, and the body never overlaps a wall by more than 5 cm."""
    deepest = 0.0
    for seed in range(1000):
        rng = np.random.default_rng(seed)
        if seed % 50 == 0:
            world = strew(seed, boxes=16, rules={"collision": "blocked"})
            sim, state = simulation(world), world.reset()
        for _ in range(4):  # each goes on where the last one ended, mostly at a wall
            waypoint = Waypoint(*(np.array(state.place) + rng.uniform(-1.5, 1.5, 3)).tolist())
            state = world.step(state, waypoint, rng).state
            assert np.isfinite(state.physics).all()
            assert 0 < state.place[0] < 8
            assert 0 < state.place[1] < 8
            mujoco.mj_forward(sim.model, sim.data)
            deepest = max(deepest, *(-sim.data.contact.dist), 0.0)
    assert deepest < 0.05
