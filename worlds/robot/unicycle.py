"""A disc that moves exactly as its wheels are told: for trainings, and for planners that look ahead.

Over a decision it ends some millimetres from where MuJoCo's body does, and touches the same walls.
"""

from typing import NamedTuple

from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.driving import Limits, Pose, command, move
from fogbench.worlds.robot.walls import touches
from fogbench.worlds.types import Array


class Drive(NamedTuple):
    """What became of one decision."""

    pose: Pose
    v: float
    """Forward speed that the wheels were told last [m/s]."""
    w: float
    """Turning speed [rad/s]."""
    length: float
    """Driven [m]."""
    touched: bool
    """Whether a wall was touched."""
    reached: bool
    """Whether the goal was."""


@kernel
def drive(
    cells: Array, cell: float, radius: float, pose: Pose, v: float, w: float,
    waypoint: Pose, limits: Limits, ticks: int, goal: tuple[float, float], near: float,
) -> tuple[Pose, float, float, float, bool, bool]:  # fmt: skip
    """Drive towards a waypoint for some ticks, or until a wall is touched or the goal is `near` [m]: a `Drive`.

    A disc that would touch a wall stays where it is and stands still.

    Args:
        cells: [H, W] uint8; of a known map, UNKNOWN counts as free.
        cell: side of its cells [m].
        radius: of the disc [m].
        pose: in metres and radians.
        v: speed at first [m/s].
        w: likewise [rad/s].
        waypoint: a pose.
        limits: see `driving`.
        ticks: at most.
        goal: a point [m].
        near: from it [m]; below 0 no goal is reached.
    """
    length = 0.0
    for _ in range(ticks):
        v, w = command(pose, v, w, waypoint, limits)
        after = move(pose, v, w)
        if touches(cells, after[0] / cell, after[1] / cell, radius / cell):
            return pose, 0.0, 0.0, length, True, False
        length += ((after[0] - pose[0]) ** 2 + (after[1] - pose[1]) ** 2) ** 0.5
        pose = after
        if (pose[0] - goal[0]) ** 2 + (pose[1] - goal[1]) ** 2 <= near * near and near >= 0:
            return pose, v, w, length, False, True
    return pose, v, w, length, False, False
