"""Many robots in one call: the episodes of `UnicycleWorld`, as arrays, by its own kernels.

Words used here
    B, n     slots, and those that a call is about
    H, W     of the largest map so far; of each slot only its own part counts
    R        beams of the widest scan of a call; behind a narrower one stand zeros
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fogbench.worlds.batch import Luck, Steps
from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.cells import enlarged
from fogbench.worlds.robot.driving import aim
from fogbench.worlds.robot.lidar import cast, misread
from fogbench.worlds.robot.odometry import odometry
from fogbench.worlds.robot.unicycle import drive
from fogbench.worlds.types import BLOCKED, Array, Observation

if TYPE_CHECKING:
    from fogbench.worlds.robot.world import UnicycleWorld


@dataclass(frozen=True, eq=False)
class RobotObservations(Sequence[Observation]):
    """What n robots are told, as arrays, and one by one."""

    steps: Array
    """[n] int64"""
    places: Array
    """[n, 3] float64"""
    views: Array
    """[n, R] float32, read-only"""
    blocked: Array
    """[n] bool"""
    beams: Array
    """[n] int64"""

    def __len__(self) -> int:
        """How many they are."""
        return len(self.places)

    def __getitem__(self, k: Any) -> Any:
        """That of one robot."""
        view = self.views[k, : self.beams[k]]
        return Observation(int(self.steps[k]), tuple(self.places[k].tolist()), view, bool(self.blocked[k]))


class RobotBatch:
    """Unicycles side by side."""

    def __init__(self, slots: int) -> None:
        """No episode yet."""
        self.cells = np.full((slots, 1, 1), BLOCKED, np.uint8)  # [B, H, W]
        self.extents = np.zeros((slots, 2), np.int64)
        self.places, self.told, self.goals = np.zeros((slots, 3)), np.zeros((slots, 3)), np.zeros((slots, 2))
        self.speeds, self.limits = np.zeros((slots, 2)), np.zeros((slots, 4))
        self.sizes = np.zeros((slots, 4))  # of a cell, the body, the way to a waypoint and the goal [m]
        self.ranges = np.zeros((slots, 2))  # of lidars: field [rad] and range [m]
        self.steps, self.budgets, self.ticks, self.beams = (np.zeros(slots, np.int64) for _ in range(4))
        self.stopped, self.fails = (np.zeros(slots, np.bool_) for _ in range(2))
        self.worlds: list[Any] = [None] * slots
        self.lucks: list[Any] = [None] * slots  # of those that need any

    def reset(self, slots: Array, worlds: "Sequence[UnicycleWorld]", lucks: Sequence[Luck]) -> None:
        """Put fresh episodes into some slots."""
        self.extents[slots] = [world.cells.shape for world in worlds]
        height, width = self.extents[slots].max(0).tolist()
        self.cells = enlarged(self.cells, (height, width), BLOCKED)
        self.steps[slots], self.stopped[slots], self.speeds[slots] = 0, False, 0
        self.places[slots] = self.told[slots] = [world.start for world in worlds]
        self.goals[slots] = [world.task.goal for world in worlds]
        self.budgets[slots] = [world.task.budget.steps for world in worlds]
        for slot, world, luck in zip(slots.tolist(), worlds, lucks, strict=True):
            self._put(slot, world, luck)

    def _put(self, slot: int, world: "UnicycleWorld", luck: Luck) -> None:
        (lidar, body, cell, near), (height, width) = world.task.sensor, world.cells.shape
        self.cells[slot, :height, :width] = world.cells
        self.limits[slot], self.ticks[slot], self.beams[slot] = body.limits, body.ticks, lidar.beams
        self.sizes[slot] = cell, body.radius, body.stride, near
        self.ranges[slot] = lidar.arc, lidar.range
        self.fails[slot] = world.rules.collision == "fails"
        needed = lidar.noise or lidar.dropped or world.rules.drift
        self.worlds[slot], self.lucks[slot] = world, luck() if needed else None

    def sense(self, slots: Array) -> RobotObservations:
        """What the robots there are told."""
        beams = self.beams[slots]
        ranges = np.zeros((len(slots), int(beams.max())))  # [n, R]
        cast_each(self.cells, self.extents, slots, self.sizes, self.places, self.ranges, self.beams, ranges)
        views = ranges.astype(np.float32)
        for k, slot in enumerate(slots.tolist()):
            if self.lucks[slot] is not None:
                views[k, : beams[k]] = misread(
                    ranges[k, : beams[k]], self.worlds[slot].task.sensor.lidar, self.lucks[slot]
                )
        views.setflags(write=False)
        return RobotObservations(self.steps[slots], self.told[slots], views[:], self.stopped[slots], beams)

    def step(self, slots: Array, actions: Sequence[Any] | Array) -> Steps:
        """Drive to waypoints [n, 3].

        Raises:
            TypeError: something is not three finite numbers.
        """
        waypoints = np.array(actions, np.float64)
        if waypoints.shape != (len(slots), 3) or not (np.abs(waypoints) < 1e9).all():
            raise TypeError(
                f"got waypoints {waypoints.tolist()}; expected three finite numbers for each of {len(slots)}"
            )
        before, lengths, reached = self.places[slots], np.empty(len(slots)), np.empty(len(slots), np.bool_)
        drive_each(
            self.cells, self.extents, slots, self.sizes, self.limits, self.ticks, self.goals, waypoints,
            self.told, self.places, self.speeds, lengths, self.stopped, reached,
        )  # fmt: skip
        self._tell(slots, before)
        self.steps[slots] += 1
        collided = self.stopped[slots] & self.fails[slots]
        return Steps(lengths, collided, reached, self.steps[slots] >= self.budgets[slots])

    def _tell(self, slots: Array, before: Array) -> None:
        """Where the robots are told that they are, which were at `before` [n, 3]."""
        for k, slot in enumerate(slots.tolist()):
            was, told, place = (tuple(pose.tolist()) for pose in (before[k], self.told[slot], self.places[slot]))
            self.told[slot] = odometry(self.worlds[slot].rules.drift, was, told, place, self.lucks[slot])


@kernel
def cast_each(
    cells: Array, extents: Array, slots: Array, sizes: Array, places: Array, ranges: Array, beams: Array, told: Array
) -> None:
    """Write true ranges into `told` [n, R]."""
    for k in range(len(slots)):
        slot = slots[k]
        own = cells[slot, : extents[slot, 0], : extents[slot, 1]]
        pose = (places[slot, 0], places[slot, 1], places[slot, 2])
        cast(own, sizes[slot, 0], pose, ranges[slot, 0], ranges[slot, 1], told[k, : beams[slot]])


@kernel
def drive_each(
    cells: Array, extents: Array, slots: Array, sizes: Array, limits: Array, ticks: Array, goals: Array,
    waypoints: Array, told: Array, places: Array, speeds: Array, lengths: Array, stopped: Array, reached: Array,
) -> None:  # fmt: skip
    """Drive the robots of some slots to `waypoints` [n, 3]."""
    for k in range(len(slots)):
        slot = slots[k]
        own = cells[slot, : extents[slot, 0], : extents[slot, 1]]
        cell, radius, stride, near = sizes[slot]
        pose = (places[slot, 0], places[slot, 1], places[slot, 2])
        waypoint = (waypoints[k, 0], waypoints[k, 1], waypoints[k, 2])
        waypoint = aim(waypoint, (told[slot, 0], told[slot, 1], told[slot, 2]), pose, stride)
        most = (limits[slot, 0], limits[slot, 1], limits[slot, 2], limits[slot, 3])
        pose, v, w, lengths[k], stopped[slot], reached[k] = drive(
            own, cell, radius, pose, speeds[slot, 0], speeds[slot, 1],
            waypoint, most, ticks[slot], (goals[slot, 0], goals[slot, 1]), near,
        )  # fmt: skip
        speeds[slot, 0], speeds[slot, 1] = v, w
        places[slot, 0], places[slot, 1], places[slot, 2] = pose
