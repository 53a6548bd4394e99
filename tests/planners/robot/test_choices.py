"""What a network chooses among, and which of it can be driven, against plain loops."""

from math import ceil, hypot, pi

import numpy as np
import pytest

from fogbench.planners.robot.choices import CHOICES, NAMES, STEP, TURNS, can_drive, chosen, span
from fogbench.planners.robot.pilot import MARGINS
from fogbench.worlds.robot.driving import command, move
from fogbench.worlds.robot.rules import Body
from fogbench.worlds.robot.walls import clearance, touches
from fogbench.worlds.types import Array

BODY = Body()


def strewn(seed: int) -> Array:
    """[80, 80] uint8, rectangles at random."""
    rng, cells = np.random.default_rng(seed), np.ones((80, 80), np.uint8)
    for _ in range(14):
        row, column, high, wide = *rng.integers(0, 80, 2), *rng.integers(2, 13, 2)
        cells[row : row + high, column : column + wide] = 2
    return cells


def test_choices_are_places_and_turns() -> None:
    """All places of the grid but the robot's own, faced as they are driven to; then turns; each has a name."""
    assert CHOICES.shape == (128, 3)
    assert len(set(NAMES)) == 128
    places, turns = CHOICES[:-TURNS], CHOICES[-TURNS:]
    steps = [-1 + STEP * k for k in range(11)]
    grid = [(ahead, left) for ahead in steps for left in steps if hypot(ahead, left) > 0.1]
    assert np.allclose(places[:, :2], grid)
    assert np.allclose(np.exp(1j * places[:, 2]), [complex(*place) / hypot(*place) for place in grid])
    assert not turns[:, :2].any()
    assert np.allclose(np.exp(1j * turns[:, 2]), np.exp(2j * pi * np.arange(TURNS) / TURNS))
    assert (NAMES[0], NAMES[-1]) == ("-1 m ahead, -1 m left", "turn by 315 degrees")


def test_a_choice_is_a_waypoint_of_a_robot() -> None:
    """Turned with it, and drawn in to the stride."""
    corner, pose = NAMES.index("1 m ahead, 1 m left"), (2.0, 3.0, pi / 2)
    assert chosen(CHOICES, corner, pose, 9.0) == pytest.approx((1.0, 4.0, 3 * pi / 4))
    assert chosen(CHOICES, corner, pose, 1.0) == pytest.approx((2 - 0.5**0.5, 3 + 0.5**0.5, 3 * pi / 4))


def touched(cells: Array, keep: float, pose: tuple[float, float, float], v: float, w: float, k: int) -> bool:
    """Whether a disc touches a wall in a decision, and in as many ticks as it brakes, tick by tick."""
    goal, still = chosen(CHOICES, k, pose, BODY.stride), pose
    for tick in range(BODY.ticks + 25):
        if tick == BODY.ticks:
            still = pose
        v, w = command(pose, v, w, goal if tick < BODY.ticks else still, BODY.limits)
        pose = move(pose, v, w)
        if touches(cells, pose[0] / 0.1, pose[1] / 0.1, keep / 0.1):
            return True
    return False


def test_what_can_be_driven_touches_nothing() -> None:
    """At random poses and speeds places ahead are told as a plain loop drives them; what lies behind can always be."""
    closed = 0
    for seed in range(20):
        cells, rng = strewn(seed), np.random.default_rng(seed)
        free = [(x, y) for x, y in rng.uniform(0.3, 7.7, (99, 2)) if not touches(cells, 10 * x, 10 * y, 2.05)]
        pose, v, w = (*free[0], rng.uniform(-pi, pi)), rng.uniform(0, 1), rng.uniform(-1, 1)
        can = np.zeros(len(CHOICES), np.bool_)
        can_drive(cells, 0.1, BODY.radius, pose, v, w, CHOICES, BODY.stride, BODY.limits, BODY.ticks, can)
        here = 0.1 * clearance(cells, 10 * pose[0], 10 * pose[1], 9.0)
        keep = min(BODY.radius + MARGINS[1], here - 1e-6)
        ahead = CHOICES[:, 0] > 0
        assert can[~ahead].all()
        for k in np.flatnonzero(ahead).tolist():
            assert can[k] == (not touched(cells, keep, pose, v, w, k))
        closed += int((~can).sum())
    assert closed > 100


def test_no_wall_beyond_the_span_matters() -> None:
    """As far as a body can come within a decision and brake, with the margin."""
    braking = BODY.speed**2 / 2 / BODY.acceleration
    least = BODY.speed * BODY.decision + braking + BODY.radius + MARGINS[1]
    assert least <= span(BODY.radius, BODY.limits, BODY.ticks) <= least + 0.05
    assert ceil(BODY.limits[0] / BODY.limits[2]) == 25
