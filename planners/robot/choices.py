"""The waypoints that a network chooses among: places around the robot, and turns on the spot.

Khan et al. 2018 choose forward, lateral and heading each by itself. A heading acts only where the robot has arrived, so
it stands here alone: at any other place it is the direction of the way there. And a place is one choice, so that of an
obstacle both sides can be likely, and its middle is not.

Words used here
    A    choices: PLACES * PLACES places but for the robot's own, then TURNS
"""

from math import ceil, pi

import numpy as np

from fogbench.planners.robot.pilot import MARGINS, safe
from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.driving import ASIDE, Limits, Pose, aim, carried
from fogbench.worlds.robot.rules import TICK
from fogbench.worlds.robot.walls import clearance
from fogbench.worlds.types import Array

PLACES = 11
"""Forward and to the left, each from -REACH to REACH."""

REACH = 1.0
"""[m]"""

STEP = 2 * REACH / (PLACES - 1)
"""From a place to the next [m]."""

TURNS = 8
"""On the spot, around the whole circle."""

OWN = PLACES * PLACES // 2
"""Where the robot's own place would be among the places."""

ORIGIN = (0.0, 0.0, 0.0)


def _poses() -> Array:
    """[A, 3] float64, as the robot sees them that stands in the origin with heading 0 [m, m, rad]."""
    steps = np.linspace(-REACH, REACH, PLACES).round(9)
    forward, left = (axis.ravel() for axis in np.meshgrid(steps, steps, indexing="ij"))
    places = np.delete(np.stack([forward, left, np.arctan2(left, forward)], -1), OWN, 0)
    turns = np.zeros((TURNS, 3))
    turns[:, 2] = 2 * pi * np.arange(TURNS) / TURNS
    return np.concatenate([places, turns])


CHOICES = _poses()
CHOICES.setflags(write=False)

NAMES = (
    *(f"{forward:g} m ahead, {left:g} m left" for forward, left, _ in CHOICES[:-TURNS].tolist()),
    *(f"turn by {360 * turn // TURNS} degrees" for turn in range(TURNS)),
)
"""What they are called."""


@kernel
def chosen(choices: Array, k: int, pose: Pose, stride: float) -> Pose:
    """A choice as a waypoint of a robot at a pose."""
    return aim(carried((choices[k, 0], choices[k, 1], choices[k, 2]), ORIGIN, pose), pose, pose, stride)


@kernel
def span(radius: float, limits: Limits, ticks: int) -> float:
    """How far from the robot a wall can be that matters to a choice [m]."""
    return limits[0] * TICK * (ticks + 1 + limits[0] / limits[2] / 2) + radius + MARGINS[1]


@kernel
def can_drive(
    cells: Array, cell: float, radius: float, pose: Pose, v: float, w: float,
    choices: Array, stride: float, limits: Limits, ticks: int, can: Array,
) -> None:  # fmt: skip
    """Write into `can` [A] bool which choices keep a margin to all walls, as the pilot tries them.

    The margin is the pilot's middle one, or what there is now if that is less. Whoever turns to what lies aside only
    brakes; nothing is better than that, so all such choices can be driven.

    Args:
        cells: [H, W] uint8 of UNKNOWN, FREE, BLOCKED.
        cell: side of its cells [m].
        radius: of the body [m].
        pose: of the robot, inside of the map.
        v: its speed [m/s].
        w: its turning speed [rad/s].
        choices: [A, 3]
        stride: the way to a waypoint at most [m].
        limits: see `driving`.
        ticks: of a decision.
        can: [A] bool.
    """
    brake, most = ceil(limits[0] / limits[2]), span(radius, limits, ticks)
    here = cell * clearance(cells, pose[0] / cell, pose[1] / cell, most / cell)
    keep = min(radius + MARGINS[1], here - 1e-6)
    for k in range(len(choices)):
        aside = abs(np.arctan2(choices[k, 1], choices[k, 0]))
        turns = aside > ASIDE + limits[1] * TICK * ticks or (choices[k, 0] == 0 and choices[k, 1] == 0)
        can[k] = turns or here >= most
        if not can[k]:
            waypoint = chosen(choices, k, pose, stride)
            can[k] = safe(cells, cell, keep, pose, v, w, waypoint, limits, ticks, brake)
