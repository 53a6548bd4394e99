"""How the robot drives: the one controller of MuJoCo's wheels, of the unicycle, and of planners that look ahead.

Words used here
    pose     x [m], y [m], heading [rad]
    v, w     forward speed [m/s] and turning speed [rad/s]
    limits   the most of v and of w, and what each may change by in a tick; see `Body.limits`
"""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.rules import TICK

ARRIVED = 0.02
"""Metres from the waypoint at which only its heading is left."""

ASIDE = 0.5
"""Radians: a waypoint that lies farther aside is turned to in place."""

ROLLING = 0.05
"""m/s: a body that is faster brakes straight before it turns in place."""

EAGER = 4.0
"""Turning speed for each radian that is left [1/s]."""

GENTLE = 0.8
"""Share of the acceleration that is planned with, so that a tick's delay makes no overshoot."""

Limits = tuple[float, float, float, float]

Pose = tuple[float, float, float]


@kernel
def wrapped(angle: float) -> float:
    """The same angle between -pi and pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


@kernel
def command(pose: Pose, v: float, w: float, waypoint: Pose, limits: Limits) -> tuple[float, float]:
    """The next v and w on the way to a waypoint: turn to it, drive there, turn to its heading."""
    wanted_v, wanted_w = 0.0, 0.0
    along, across = waypoint[0] - pose[0], waypoint[1] - pose[1]
    left = np.hypot(along, across)
    aside = wrapped((waypoint[2] if left < ARRIVED else np.arctan2(across, along)) - pose[2])
    if left >= ARRIVED and abs(aside) <= ASIDE:
        wanted_v = min(limits[0], np.sqrt(2 * GENTLE * limits[2] / TICK * left)) * np.cos(aside)
    if wanted_v > 0 or abs(v) <= ROLLING:
        stop = np.sqrt(2 * GENTLE * limits[3] / TICK * abs(aside))
        wanted_w = np.sign(aside) * min(limits[1], stop, EAGER * abs(aside))
    return v + clipped(wanted_v - v, limits[2]), w + clipped(wanted_w - w, limits[3])


@kernel
def clipped(number: float, most: float) -> float:
    """A number between -most and most."""
    return min(max(number, -most), most)


@kernel
def move(pose: Pose, v: float, w: float) -> Pose:
    """Where a unicycle is a tick later."""
    middle = pose[2] + w * TICK / 2
    return pose[0] + v * TICK * np.cos(middle), pose[1] + v * TICK * np.sin(middle), wrapped(pose[2] + w * TICK)


@kernel
def speeds_after(pose: Pose, v: float, w: float, waypoint: Pose, limits: Limits, ticks: int) -> tuple[float, float]:
    """The speeds after a decision that no wall cuts short."""
    for _ in range(ticks):
        v, w = command(pose, v, w, waypoint, limits)
        pose = move(pose, v, w)
    return v, w


@kernel
def carried(pose: Pose, here: Pose, there: Pose) -> Pose:
    """A pose that is to `there` as the given one is to `here`."""
    turn = there[2] - here[2]
    x, y = pose[0] - here[0], pose[1] - here[1]
    along, across = x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)
    return there[0] + along, there[1] + across, wrapped(pose[2] + turn)


@kernel
def aim(waypoint: Pose, told: Pose, pose: Pose, stride: float) -> Pose:
    """Where a robot at a pose drives to that is told another: no farther than `stride` [m]."""
    there = carried(waypoint, told, pose)
    along, across = there[0] - pose[0], there[1] - pose[1]
    share = min(1.0, stride / max(np.hypot(along, across), 1e-9))
    return pose[0] + share * along, pose[1] + share * across, there[2]
