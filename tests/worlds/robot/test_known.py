"""The known map: by hand, and against the truth it is a part of."""

from collections.abc import Callable
from math import pi

import numpy as np

from fogbench.worlds.robot.gaps import gaps, rings
from fogbench.worlds.robot.known import RobotMap, reach
from fogbench.worlds.robot.rules import Body, Lidar, Outfit
from fogbench.worlds.robot.world import RobotState, RobotWorld
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array, Budget, Observation, Task

OUTFIT = Outfit(Lidar(beams=1, field=1, range=10), Body(), 1.0, 0.3)


def looked(known: RobotMap, *looks: tuple[float, float, float, float]) -> Array:
    """The cells after some looks of one beam: x, y, heading and range [m]."""
    for x, y, heading, far in looks:
        known.update(Observation(0, (x, y, heading), np.array([far], np.float32), blocked=False))
    return known.cells


def empty(width: float = 5, height: float = 1) -> RobotMap:
    """A map of nothing."""
    return RobotMap(Task("robot", (0.5, 0.5), OUTFIT, Budget(1), (width, height)))


def test_a_beam_frees_its_way_and_blocks_its_end() -> None:
    """Up to the cell just behind the point where it ends; what lies behind stays unknown."""
    assert looked(empty(), (0.5, 0.5, 0.0, 2.5)).tolist() == [[FREE, FREE, FREE, BLOCKED, UNKNOWN]]


def test_a_beam_that_meets_nothing_blocks_nothing() -> None:
    """It frees all it crosses, up to the border at most."""
    assert looked(empty(), (0.5, 0.5, 0.0, 10.0)).tolist() == [[FREE] * 5]


def test_a_dropped_beam_tells_nothing() -> None:
    """But the cell that the robot is in is free."""
    assert looked(empty(), (0.5, 0.5, 0.0, 0.0)).tolist() == [[FREE, UNKNOWN, UNKNOWN, UNKNOWN, UNKNOWN]]


def test_the_latest_reading_wins() -> None:
    """A blocked cell is freed by a beam that crosses it, and blocked again."""
    known = empty()
    assert looked(known, (0.5, 0.5, 0.0, 1.5), (0.5, 0.5, 0.0, 3.5)).tolist() == [[FREE] * 4 + [BLOCKED]]
    assert looked(known, (4.5, 0.5, pi, 1.5)).tolist() == [[FREE, FREE, BLOCKED, FREE, FREE]]


def test_within_a_scan_blocked_wins() -> None:
    """A cell that one beam meets and another crosses is blocked, in whatever order they come."""
    known = RobotMap(Task("robot", (0.5, 0.5), OUTFIT._replace(lidar=Lidar(beams=2, field=1)), Budget(1), (5, 1)))
    for ranges in ([1.6, 3.6], [3.6, 1.6]):
        known.update(Observation(0, (0.5, 0.5, 0.0), np.array(ranges, np.float32), blocked=False))
        assert known.cells.tolist() == [[FREE, FREE, BLOCKED, FREE, BLOCKED]]


def test_exact_scans_tell_nothing_but_the_truth(strew: Callable[..., RobotWorld]) -> None:
    """From 100 places in each of ten worlds no free cell is ever blocked and no blocked one freed; gaps are kept up."""
    for seed in range(10):
        world = strew(seed, boxes=14)
        known, rng = world.known(), np.random.default_rng(seed)
        for x, y, heading in rng.uniform((0, 0, -pi), (8, 8, pi), (100, 3)).tolist():
            if world.cells[int(y / 0.1), int(x / 0.1)] == BLOCKED:
                continue
            place = (x, y, heading)
            state = RobotState(0, place, place, 0.0, 0.0, None, blocked=False)
            before = known.gap.copy()
            changed = known.update(world.sense(state, rng))
            seen = known.cells != UNKNOWN
            assert (known.cells[seen] == world.cells[seen]).all()
            assert set(np.flatnonzero(known.gap != before).tolist()) <= set(changed.tolist())
        assert np.array_equal(known.gap, gaps(known.cells, rings(reach(world.task.sensor))))
        assert seen.mean() > 0.6


def test_noise_and_drift_leave_gaps_kept_up(strew: Callable[..., RobotWorld]) -> None:
    """Cells come and go, and gaps are those of the map at the end."""
    world = strew(3, sensor={"noise": 0.05, "dropped": 0.1})
    known, rng = world.known(), np.random.default_rng(0)
    for _ in range(50):
        known.update(world.sense(world.reset(), rng))
    assert np.array_equal(known.gap, gaps(known.cells, rings(reach(world.task.sensor))))
    assert (known.cells == BLOCKED).any()
