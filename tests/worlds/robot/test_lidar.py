"""What a lidar shows, by hand and against MuJoCo's own rays."""

from collections.abc import Callable
from math import pi, sqrt
from typing import Any

import mujoco
import numpy as np
import pytest

from fogbench.worlds.robot.lidar import bearing, cast, misread
from fogbench.worlds.robot.rules import Lidar
from fogbench.worlds.robot.world import RobotWorld, simulation
from fogbench.worlds.types import BLOCKED, FREE, Array

Strew = Callable[..., RobotWorld]


def ranges_of(cells: Array, cell: float, pose: Any, lidar: Lidar) -> Array:
    """What is truly measured."""
    ranges = np.empty(lidar.beams)
    cast(cells, cell, pose, lidar.arc, lidar.range, ranges)
    return ranges


def test_beams_are_spread_evenly() -> None:
    """Each stands in the middle of its part of the field, the first to the right."""
    assert [bearing(k, 4, 2 * pi) for k in range(4)] == pytest.approx([-0.75 * pi, -0.25 * pi, 0.25 * pi, 0.75 * pi])
    assert bearing(0, 1, 1.5 * pi) == 0


def test_a_room_by_hand() -> None:
    """A room of 3 x 2 m seen from (1.5, 0.5): to its border, to a block above, and no farther than the range."""
    cells = np.full((2, 3), FREE, np.uint8)
    cells[1, 1] = BLOCKED
    aslant = ranges_of(cells, 1.0, (1.25, 0.5, 0.0), Lidar(beams=4, field=360))
    assert aslant == pytest.approx([sqrt(0.5), sqrt(0.5), sqrt(0.5), 1.25 * sqrt(2)])
    straight = [ranges_of(cells, 1.0, (1.5, 0.5, k * pi / 2), Lidar(beams=1))[0] for k in range(4)]
    assert straight == pytest.approx([1.5, 0.5, 1.5, 0.5])
    assert ranges_of(cells, 1.0, (1.5, 0.5, 0.0), Lidar(beams=1, range=1.2)) == 1.2


def test_a_cell_is_as_large_as_it_is() -> None:
    """The same room of cells of 20 cm has ranges of a fifth."""
    cells = np.full((2, 3), FREE, np.uint8)
    wide = ranges_of(cells, 1.0, (1.5, 0.5, 0.3), Lidar(beams=50))
    assert ranges_of(cells, 0.2, (0.3, 0.1, 0.3), Lidar(beams=50)) == pytest.approx(wide / 5)


def test_ranges_are_those_of_mujoco(strew: Strew) -> None:
    """At 10,000 random poses in 20 worlds, within a micrometre."""
    worst, lidar = 0.0, Lidar(beams=30, field=360, range=20)
    for seed in range(20):
        world, rng = strew(seed, boxes=14), np.random.default_rng(seed)
        poses = rng.uniform((0, 0, -pi), (8, 8, pi), (1000, 3))
        free = [pose for pose in poses.tolist() if world.cells[int(pose[1] / 0.1), int(pose[0] / 0.1)] != BLOCKED][:500]
        assert len(free) == 500
        for pose in free:
            own = ranges_of(world.cells, 0.1, tuple(pose), lidar)
            worst = max(worst, float(np.abs(own - rays(world, pose, lidar)).max()))
    assert worst < 1e-6


def rays(world: RobotWorld, pose: Any, lidar: Lidar) -> Array:
    """What MuJoCo measures, without the robot itself."""
    sim = simulation(world)
    angles = [pose[2] + bearing(k, lidar.beams, lidar.arc) for k in range(lidar.beams)]
    ways = np.array([(np.cos(angle), np.sin(angle), 0) for angle in angles]).ravel()
    found, geoms = np.empty(lidar.beams), np.empty(lidar.beams, np.int32)
    groups, robot = np.ones(6, np.uint8), sim.model.body("robot").id
    sim.data.qpos[2] = 50  # out of the way
    mujoco.mj_kinematics(sim.model, sim.data)
    point = np.array([pose[0], pose[1], 0.2])
    mujoco.mj_multiRay(
        sim.model, sim.data, point, ways, groups, True, robot, geoms, found, None, lidar.beams, lidar.range
    )
    return np.where(found < 0, lidar.range, np.minimum(found, lidar.range))


def test_noise_is_of_what_meets_a_wall() -> None:
    """It has the deviation that is asked for, nothing leaves the range, and free beams stay."""
    ranges = np.repeat([2.0, 9.99, 10.0], 3000)
    told = misread(ranges, Lidar(beams=9000, noise=0.05), np.random.default_rng(0))
    assert told.dtype == np.float32
    assert np.std(told[:3000]) == pytest.approx(0.05, rel=0.05)
    assert told.max() == 10
    assert (told[6000:] == 10).all()


def test_streams_do_not_shift() -> None:
    """As many numbers are drawn whatever there is to see; none without noise."""
    for lidar, drawn in ((Lidar(beams=7), 0), (Lidar(beams=7, noise=0.1), 7), (Lidar(beams=7, dropped=0.5), 7)):
        states = []
        for ranges in (np.full(7, 1.0), np.full(7, 10.0)):
            rng = np.random.default_rng(3)
            misread(ranges, lidar, rng)
            states.append(rng.bit_generator.state)
        assert states[0] == states[1]
        assert (states[0] == np.random.default_rng(3).bit_generator.state) == (drawn == 0)


def test_dropped_beams_read_nothing() -> None:
    """As many as is asked for."""
    told = misread(np.full(10000, 3.0), Lidar(beams=10000, dropped=0.3), np.random.default_rng(0))
    assert set(told.tolist()) == {0.0, 3.0}
    assert np.mean(told == 0) == pytest.approx(0.3, abs=0.02)
