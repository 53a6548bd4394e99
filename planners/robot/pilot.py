"""How the path of any planner is driven: towards the farthest point of it that is in sight, as far as that is safe.

A point is in sight if the body has room on the straight line to it. A waypoint is driven to on the known map first,
by the unicycle: for one decision, and on until it stands. It is safe if that keeps a margin to all known walls, as
large as there is room for. Where no point of the path is safe, the robot brakes and turns; if that does not help, it
makes room for itself: it drives to where the walls are farthest.
"""

from math import atan2, cos, hypot, pi, sin

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.driving import Limits, Pose, aim, speeds_after
from fogbench.worlds.robot.rules import Outfit
from fogbench.worlds.robot.unicycle import drive
from fogbench.worlds.robot.walls import clearance, touches
from fogbench.worlds.types import Array, Waypoint

MARGINS = 0.06, 0.03, 0.01
"""Metres between body and wall, the first at which any waypoint is safe."""

BRAKE = 100
"""Ticks in which any body stands."""

PATIENCE = 3
"""Decisions in which the robot may stay where it is before it makes room."""

STILL = 0.05
"""Metres: who has moved less has stayed."""

ROUND = 16
"""Directions in which room is looked for."""

SIGHT = 4.0
"""Metres of a path that are looked at."""

NOWHERE = (0.0, 0.0)


class Pilot:
    """Drives one robot along paths."""

    def __init__(self, outfit: Outfit) -> None:
        """Standing still."""
        self.outfit = outfit
        self.v = self.w = 0.0
        self.since: Pose = (-1.0, -1.0, 0.0)  # where it has stayed
        self.stayed = 0

    def waypoint(self, cells: Array, pose: Pose, path: Array, wish: Pose | None = None) -> Waypoint:
        """The next waypoint.

        Args:
            cells: [H, W] uint8, the known map.
            pose: of the robot.
            path: [n, 2] float64, the points from here to the goal [m]; at least one.
            wish: where to drive instead if that is safe.
        """
        moved = hypot(pose[0] - self.since[0], pose[1] - self.since[1]) > STILL
        self.since, self.stayed = (pose, 0) if moved else (self.since, self.stayed + 1)
        if self.stayed > PATIENCE:
            chosen = self._room(cells, pose)
        elif wish is not None and self._is_safe(cells, pose, wish):
            chosen = wish
        else:
            chosen = self._ahead(cells, pose, path)
        if chosen is None:
            ahead = path[min(len(path) - 1, 3)]
            chosen = (pose[0], pose[1], atan2(ahead[1] - pose[1], ahead[0] - pose[0]))
        return self._sent(pose, chosen)

    def _ahead(self, cells: Array, pose: Pose, path: Array) -> Pose | None:
        """Towards the farthest point of the path that is in sight and safe, with the heading of the path behind it."""
        body, cell = self.outfit.body, self.outfit.cell
        here = cell * clearance(cells, pose[0] / cell, pose[1] / cell, (body.radius + MARGINS[0]) / cell)
        for margin in MARGINS:
            keep = min(body.radius + margin, here - 1e-6)
            k = farthest(cells, cell, keep, pose, self.v, self.w, path, body.stride, body.limits, body.ticks)
            if k >= 0:
                return aim((path[k, 0], path[k, 1], _heading(path, k)), pose, pose, body.stride)
        return None

    def _is_safe(self, cells: Array, pose: Pose, wish: Pose) -> bool:
        """Whether a waypoint can be driven to with the middle margin."""
        body, cell = self.outfit.body, self.outfit.cell
        return safe(
            cells, cell, body.radius + MARGINS[1], pose, self.v, self.w, aim(wish, pose, pose, body.stride),
            body.limits, body.ticks,
        )  # fmt: skip

    def _room(self, cells: Array, pose: Pose) -> Pose | None:
        """Of safe points around, that with the widest room; each time it is asked, the next best counts."""
        body, cell = self.outfit.body, self.outfit.cell
        here = cell * clearance(cells, pose[0] / cell, pose[1] / cell, body.radius / cell)
        found: list[tuple[float, Pose]] = []
        for k in range(ROUND):
            angle = 2 * pi * k / ROUND
            x, y = pose[0] + body.radius * cos(angle), pose[1] + body.radius * sin(angle)
            point = np.array([[x, y]])
            if farthest(cells, cell, here - 1e-6, pose, self.v, self.w, point, 9.9, body.limits, 3 * body.ticks) == 0:
                found.append((-clearance(cells, x / cell, y / cell, 3 * body.radius / cell), (x, y, angle)))
        found.sort()
        return found[(self.stayed - PATIENCE - 1) // 2 % len(found)][1] if found else None

    def _sent(self, pose: Pose, chosen: Pose) -> Waypoint:
        """The waypoint, after note was taken of the speed that it will leave."""
        body = self.outfit.body
        self.v, self.w = speeds_after(pose, self.v, self.w, chosen, body.limits, body.ticks)
        return Waypoint(*map(float, chosen))


def _heading(path: Array, k: int) -> float:
    """Of the path behind its `k`th point."""
    a, b = path[max(0, min(k, len(path) - 2))], path[min(k + 3, len(path) - 1)]
    return atan2(b[1] - a[1], b[0] - a[0])


@kernel
def farthest(
    cells: Array, cell: float, keep: float, pose: Pose, v: float, w: float,
    path: Array, stride: float, limits: Limits, ticks: int,
) -> int:  # fmt: skip
    """The last point of a path [n, 2] that is in sight and can be driven towards, with `keep` [m] to all walls.

    Points are tried from the last on, ever nearer by a cell or more.

    Returns:
        Its number; -1 where there is none.
    """
    last, tried = 0, 1e30
    while last + 1 < len(path) and np.hypot(path[last + 1, 0] - pose[0], path[last + 1, 1] - pose[1]) <= SIGHT:
        last += 1
    for k in range(last, -1, -1):
        far = np.hypot(path[k, 0] - pose[0], path[k, 1] - pose[1])
        if far > tried - cell and k > 0:
            continue
        if far < cell / 2 and k < last:
            break
        tried = far
        if far > stride and not in_sight(cells, cell, keep, pose, path[k, 0], path[k, 1]):
            continue
        waypoint = aim(
            (path[k, 0], path[k, 1], np.arctan2(path[k, 1] - pose[1], path[k, 0] - pose[0])), pose, pose, stride
        )
        if safe(cells, cell, keep, pose, v, w, waypoint, limits, ticks):
            return k
    return -1


@kernel
def in_sight(cells: Array, cell: float, keep: float, pose: Pose, x: float, y: float) -> bool:
    """Whether a disc of radius `keep` [m] touches nothing on the straight line to a point, by half cells."""
    steps = int(np.hypot(x - pose[0], y - pose[1]) / cell * 2) + 1
    for k in range(1, steps + 1):
        share = k / steps
        across, along = pose[0] + share * (x - pose[0]), pose[1] + share * (y - pose[1])
        if touches(cells, across / cell, along / cell, keep / cell):
            return False
    return True


@kernel
def safe(
    cells: Array, cell: float, keep: float, pose: Pose, v: float, w: float,
    waypoint: Pose, limits: Limits, ticks: int, brake: int = BRAKE,
) -> bool:  # fmt: skip
    """Whether a disc of radius `keep` [m] can drive to a waypoint for some ticks, and brake then, and touch nothing."""
    pose, v, w, _, touched, _ = drive(cells, cell, keep, pose, v, w, waypoint, limits, ticks, NOWHERE, -1.0)
    if touched:
        return False
    return not drive(cells, cell, keep, pose, v, w, pose, limits, brake, NOWHERE, -1.0)[4]
