"""From what robots are told to what a network sees; one implementation for single decisions and for batches.

Words used here
    B        samples
    R        beams of the widest scan; behind a narrower one stand zeros, which tell nothing
    bodies   [B, 12] float64, what robots are, see `body_of`
    S        rows and columns of an image
    image    [B, 3, S, S] what the VI module plans on: seen to be free, seen to be blocked, the goal
    beams    [B, BEAMS] how near and how far the nearest wall is in each sector
    compass  [B, COMPASS] where the goal is, how the robot moves, and where it is on the map

An image is what the robot faces: it stands at the middle of the lower edge and looks up. A goal outside is moved to the
nearest cell.
"""

from math import log1p
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.encoding.robot_sizes import BEAMS, BEARINGS, CHANNELS, COMPASS, FAR, RINGS, SECTORS, WAVES
from fogbench.planners.robot.choices import CHOICES, ORIGIN, can_drive, span
from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.driving import carried
from fogbench.worlds.robot.known import fuse
from fogbench.worlds.robot.lidar import bearing
from fogbench.worlds.robot.rules import Outfit
from fogbench.worlds.types import FREE, UNKNOWN, Array


class Told(NamedTuple):
    """What some robots are told at one step, as arrays."""

    ranges: Array
    """[B, R] float32 [m]."""
    poses: Array
    """[B, 3] float64."""
    before: Array
    """[B, 3] float64, the poses before the last decision; at first the same."""
    speeds: Array
    """[B, 2] float64, forward and turning."""
    last: Array
    """[B, 3] float64, the last choice; zeros before the first."""
    goals: Array
    """[B, 2] float64."""
    blocked: Array
    """[B] bool, whether a wall was touched."""
    bodies: Array
    """[B, 12] float64."""


class RobotInputs(NamedTuple):
    """What a network sees, for a batch; and what tells which of its outputs are open."""

    image: Tensor
    """[B, 3, S, S] float32."""
    cells: Tensor
    """[B] int64, where the robots are in the image."""
    beams: Tensor
    """[B, BEAMS] float32."""
    compass: Tensor
    """[B, COMPASS] float32."""
    ranges: Array
    """[B, R] float32."""
    poses: Array
    """[B, 3] float64."""
    speeds: Array
    """[B, 2] float64."""
    bodies: Array
    """[B, 12] float64."""

    def to(self, device: str) -> "RobotInputs":
        """The same on a device."""
        if self.image.device.type == device:
            return self
        image, cells, beams, compass = (part.to(device) for part in self[:4])
        return self._replace(image=image, cells=cells, beams=beams, compass=compass)

    @property
    def beside(self) -> tuple[Tensor, Tensor, Tensor]:
        """What a memory is told as it is."""
        return self.image.flatten(1), self.beams, self.compass


def body_of(outfit: Outfit, extent: tuple[float, ...]) -> tuple[float, ...]:
    """Cell, radius, stride, four limits, ticks; beams, field and range; the map's longer side."""
    lidar, body, cell, _ = outfit
    driven = cell, body.radius, body.stride, *body.limits, body.ticks
    return *driven, lidar.beams, lidar.arc, lidar.range, max(extent)


def encode(told: Told, side: int, cell: float) -> RobotInputs:
    """What a network sees of what some robots are told, with an image of `side` cells of `cell` [m] to each side."""
    batch = len(told.poses)
    image = np.zeros((batch, CHANNELS, side, side), np.float32)
    beams, compass = np.zeros((batch, BEAMS), np.float32), np.zeros((batch, COMPASS), np.float32)
    draw(told.ranges, told.poses, told.goals, told.bodies, cell, image)
    sweep(told.ranges, told.bodies, beams)
    point(told.poses, told.before, told.speeds, told.last, told.goals, told.blocked, told.bodies, compass)
    here = np.full(batch, (side - 1) * side + side // 2)
    shown, cells, swept, pointed = map(torch.from_numpy, (image, here, beams, compass))
    return RobotInputs(shown, cells, swept, pointed, told.ranges, told.poses, told.speeds, told.bodies)


@kernel
def seen_from(pose: Array, x: float, y: float) -> tuple[float, float]:
    """A point as the robot sees it: forward and to the left [m]."""
    place = carried((x, y, 0.0), (pose[0], pose[1], pose[2]), ORIGIN)
    return place[0], place[1]


@kernel
def draw(ranges: Array, poses: Array, goals: Array, bodies: Array, cell: float, image: Array) -> None:
    """Draw scans and goals into images of zeros; a scan is written into a map of coarse cells as into any other."""
    side = image.shape[2]
    for b in range(len(image)):
        cells = np.full((side, side), UNKNOWN, np.uint8)
        count, field, most = int(bodies[b, 8]), bodies[b, 9], bodies[b, 10]
        fuse(cells, ranges[b, :count], side / 2, 0.0, np.pi / 2, field, most, cell)
        for row in range(side):
            for column in range(side):
                if cells[row, column] != UNKNOWN:
                    image[b, cells[row, column] - FREE, side - 1 - row, column] = 1
        ahead, left = seen_from(poses[b], goals[b, 0], goals[b, 1])
        row = int(min(max(ahead / cell, 0), side - 1))
        column = int(min(max(side / 2 - left / cell, 0), side - 1))
        image[b, 2, side - 1 - row, column] = 1


@kernel
def sweep(ranges: Array, bodies: Array, beams: Array) -> None:
    """Fill beams: of each sector, from behind counterclockwise, how near a wall is in each ring, and how far it is."""
    rings = len(RINGS)
    for b in range(len(beams)):
        told, count = beams[b].reshape((rings + 1, SECTORS)), int(bodies[b, 8])
        told[rings] = 1  # where nothing is seen
        for beam in range(count):
            if ranges[b, beam] > 0:
                sector = int((bearing(beam, count, bodies[b, 9]) / (2 * np.pi) + 0.5) * SECTORS) % SECTORS
                left = max(ranges[b, beam] - bodies[b, 1], 0.0)
                told[rings, sector] = min(told[rings, sector], left / FAR)
                for ring in range(rings):
                    told[ring, sector] = max(told[ring, sector], 1 - left / RINGS[ring])


@kernel
def point(
    poses: Array, before: Array, speeds: Array, last: Array, goals: Array, blocked: Array, bodies: Array, compass: Array
) -> None:
    """Fill compasses of zeros; a direction is told by its share in the two nearest of BEARINGS, a place by waves."""
    for b in range(len(compass)):
        told, pose = compass[b, BEARINGS:], poses[b]
        ahead, left = seen_from(pose, goals[b, 0], goals[b, 1])
        far = np.hypot(ahead, left)
        turn = (np.arctan2(left, ahead) / (2 * np.pi) + 0.5) * BEARINGS
        compass[b, int(turn) % BEARINGS] = 1 - turn % 1
        compass[b, (int(turn) + 1) % BEARINGS] = turn % 1
        moved = carried((pose[0], pose[1], pose[2]), (before[b, 0], before[b, 1], before[b, 2]), ORIGIN)
        told[0], told[1] = log1p(far), min(far / FAR, 1.0)
        told[2], told[3] = speeds[b, 0] / bodies[b, 3], speeds[b, 1] / bodies[b, 4]
        told[4], told[5], told[6] = moved
        told[7], told[8] = last[b, 0], last[b, 1]
        told[9], told[10] = np.cos(last[b, 2]), np.sin(last[b, 2])
        told[11] = blocked[b]
        told[12], told[13] = np.cos(pose[2]), np.sin(pose[2])
        for k, place in enumerate((pose[0], pose[1], goals[b, 0], goals[b, 1])):
            for wave in range(WAVES):
                angle = np.pi * 2**wave * place / bodies[b, 11]
                at = 14 + 2 * (k * WAVES + wave)
                told[at], told[at + 1] = np.cos(angle), np.sin(angle)


def open_choices(inputs: RobotInputs) -> Array:
    """[B, A] bool, the choices that can be driven by what each robot's scan shows."""
    told = np.empty((len(inputs.poses), len(CHOICES)), np.bool_)
    open_each(inputs.ranges, inputs.poses, inputs.speeds, inputs.bodies, CHOICES, told)
    return told


@kernel
def open_each(ranges: Array, poses: Array, speeds: Array, bodies: Array, choices: Array, told: Array) -> None:
    """Write scans into maps of the world's own cells, each as far as matters, and try all choices there."""
    for b in range(len(poses)):
        cell, radius, stride = bodies[b, 0], bodies[b, 1], bodies[b, 2]
        limits = (bodies[b, 3], bodies[b, 4], bodies[b, 5], bodies[b, 6])
        ticks, count = int(bodies[b, 7]), int(bodies[b, 8])
        around = int(span(radius, limits, ticks) / cell) + 2
        x, y = poses[b, 0] / cell, poses[b, 1] / cell
        x, y = x - np.floor(x) + around, y - np.floor(y) + around
        cells = np.full((2 * around + 1, 2 * around + 1), UNKNOWN, np.uint8)
        fuse(cells, ranges[b, :count], x, y, poses[b, 2], bodies[b, 9], bodies[b, 10], cell)
        pose = (x * cell, y * cell, poses[b, 2])
        can_drive(cells, cell, radius, pose, speeds[b, 0], speeds[b, 1], choices, stride, limits, ticks, told[b])
