"""A robot with a lidar that drives among rectangles, beside the same in ir-sim.

Both have the same 20 x 20 m with 60 rectangles, a round body of 0.2 m, 270 beams over 270 degrees, and drive 0.1 s at a
step. Before anything is timed, both must see the same from many places. Ours drives to random waypoints, theirs at
random speeds, from fresh places; a wall stops either. ir-sim has no physics: its body goes where its wheels say, as our
unicycle does. The robot of the scenarios has wheels, friction and contacts in MuJoCo.
"""

import tempfile
from collections.abc import Iterator
from dataclasses import replace
from itertools import count
from pathlib import Path
from time import process_time
from typing import Any

import irsim
import numpy as np
import yaml
from turns import Round, Turns, per_second

from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.robot.walls import clearance, rectangles
from fogbench.worlds.robot.world import RobotState
from fogbench.worlds.types import Waypoint

STEPS = 50
"""In a round, from a fresh place."""

HALLS = Blobs(size=200, obstacles=(60, 60), obstacle_size=(5, 20))
BEAMS, SIDE, RADIUS = 270, 0.1, 0.2


def drives() -> Iterator[Turns]:
    """Both worlds of ours beside theirs."""
    for physics, work in (("mujoco", "a robot's step and scan, MuJoCo"), ("unicycle", "the same, a unicycle")):
        world = world_of(physics)
        env = env_of(world)
        agree(world, env)
        yield Turns.take(work, "ir-sim", our_round(world), their_round(world, env), per_second)


def world_of(physics: str) -> Any:
    """The hall of one seed."""
    conditions = {
        "body": {"decision": 0.1, "radius": RADIUS},
        "sensor": {"beams": BEAMS},
        "rules": {"physics": physics, "collision": "blocked"},
        "budget": {"steps": 2000},
    }
    return HALLS.sample(np.random.default_rng(0), 0, RobotConditions.model_validate(conditions))


def env_of(world: Any) -> Any:
    """The same hall in ir-sim, with walls around it; its first and last beam stand at the ends of the field."""
    lidar, most = world.task.sensor.lidar, 20.0
    boxes = (SIDE * rectangles(world.cells)).tolist()  # row, column, rows and columns of each
    boxes += [(-1, -1, 1, most + 2), (most, -1, 1, most + 2), (0, -1, most, 1), (0, most, most, 1)]
    sensor = {
        "name": "lidar2d", "range_max": lidar.range, "number": BEAMS, "angle_range": lidar.arc * (1 - 1 / BEAMS)
    }  # fmt: skip
    robot = {
        "kinematics": {"name": "diff"}, "shape": {"name": "circle", "radius": RADIUS}, "state": [*world.start],
        "goal": [*world.task.goal, 0], "vel_max": [1, 2], "vel_min": [-1, -2], "sensors": [sensor],
    }  # fmt: skip
    walls = [
        {
            "shape": {"name": "rectangle", "length": wide, "width": high},
            "state": [left + wide / 2, low + high / 2, 0],
        }
        for low, left, high, wide in boxes
    ]
    said = {"width": most, "height": most, "step_time": 0.1, "sample_time": 0.1, "collision_mode": "stop"}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "hall.yaml")
        path.write_text(yaml.safe_dump({"world": said, "robot": [robot], "obstacle": walls}), "utf-8")
        return irsim.make(str(path), headless=True, log_level="ERROR")


def agree(world: Any, env: Any) -> None:
    """Hold what both see from twenty places against each other."""
    for pose, _ in zip(poses(world), range(20), strict=False):
        ours = world.sense(standing(pose), np.random.default_rng(0)).view
        put(env, pose)
        env.step(np.zeros((2, 1)))
        if np.mean(np.abs(ours - env.get_lidar_scan()["ranges"]) < 1e-3) < 0.99:  # corners are seen from a hair beside
            raise SystemExit("the two lidars differ")


def our_round(world: Any) -> Round:
    """Seconds per step and scan."""
    places, rng = poses(world), np.random.default_rng(1)

    def one_round() -> float:
        state = replace(world, start=next(places)).reset()
        waypoints = (np.array([*state.place]) + rng.uniform(-1, 1, (STEPS, 3))).tolist()
        began = process_time()
        for waypoint in waypoints:
            state = world.step(state, Waypoint(*waypoint), rng).state
            world.sense(state, rng)
        return (process_time() - began) / STEPS

    return one_round


def their_round(world: Any, env: Any) -> Round:
    """Seconds per step and scan of ir-sim."""
    places, rng = poses(world), np.random.default_rng(2)

    def one_round() -> float:
        put(env, next(places))
        speeds = rng.uniform((-1, -2), (1, 2), (STEPS, 2))[:, :, None]
        began = process_time()
        for speed in speeds:
            env.step(speed)
            env.get_lidar_scan()
        return (process_time() - began) / STEPS

    return one_round


def poses(world: Any) -> Iterator[tuple[float, float, float]]:
    """Fresh places with room for the body, without end."""
    for number in count():
        x, y, heading = np.random.default_rng(number).uniform((0, 0, -3), (20, 20, 3)).tolist()
        if SIDE * clearance(world.cells, x / SIDE, y / SIDE, 5) > 1.5 * RADIUS:
            yield x, y, heading


def standing(pose: tuple[float, float, float]) -> RobotState:
    """A robot that only looks."""
    return RobotState(0, pose, pose, 0.0, 0.0, None, blocked=False)


def put(env: Any, pose: tuple[float, float, float]) -> None:
    """Their robot, standing still."""
    env.reset()
    env.robot.set_state(np.array(pose)[:, None])
