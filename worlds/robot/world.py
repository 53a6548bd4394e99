"""The robot world: walls of cells, a body that drives to waypoints, a lidar."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import hypot
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fogbench.worlds.maps.covariates import covariates
from fogbench.worlds.picture import Picture
from fogbench.worlds.robot.driving import Pose, aim
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.robot.lidar import cast, misread
from fogbench.worlds.robot.odometry import odometry
from fogbench.worlds.robot.pictures import picture
from fogbench.worlds.robot.rules import Outfit, RobotRules
from fogbench.worlds.robot.simulation import Simulation
from fogbench.worlds.robot.unicycle import Drive, drive
from fogbench.worlds.robot.ways import way
from fogbench.worlds.types import BLOCKED, Array, Observation, Step, Task, Waypoint

if TYPE_CHECKING:
    from fogbench.worlds.batch import Batch


class RobotState(NamedTuple):
    """Where an episode stands."""

    step: int
    place: Pose
    """Where the robot is [m, m, rad]."""
    told: Pose
    """Where its odometry says that it is."""
    v: float
    """Speed that its wheels were told last [m/s]."""
    w: float
    """Turning speed [rad/s]."""
    physics: Any
    """[n] float64, the whole state of MuJoCo, read-only; None of a unicycle."""
    blocked: bool
    """Whether it touched a wall on its way here."""


@dataclass(frozen=True, eq=False)
class RobotWorld:
    """One map with one task, in MuJoCo."""

    cells: Array
    """[H, W] uint8 of FREE and BLOCKED, row 0 at the bottom, read-only."""
    start: Pose
    task: Task
    rules: RobotRules

    def reset(self) -> RobotState:
        """The state before the first decision."""
        return RobotState(0, self.start, self.start, 0.0, 0.0, self._at_rest(), blocked=False)

    def sense(self, state: RobotState, rng: np.random.Generator) -> Observation:
        """What the agent is told; with noise or dropped beams, a number for each beam is drawn whatever the truth."""
        outfit: Outfit = self.task.sensor
        ranges = np.empty(outfit.lidar.beams)
        cast(self.cells, outfit.cell, state.place, outfit.lidar.arc, outfit.lidar.range, ranges)
        view = misread(ranges, outfit.lidar, rng)
        view.setflags(write=False)
        return Observation(state.step, state.told, view[:], state.blocked)  # who does not own it cannot unlock it

    def step(self, state: RobotState, action: Any, rng: np.random.Generator) -> Step:
        """Drive to a waypoint, as far as a decision's time and the walls allow.

        Raises:
            TypeError: `action` is not a `Waypoint` of three finite numbers.
        """
        if type(action) is not Waypoint or not all(isinstance(n, int | float) and abs(n) < 1e9 for n in action):
            got = f"{action!r} ({type(action).__name__})"
            raise TypeError(f"act returned {got}; expected a Waypoint of finite numbers or None")
        x, y, heading = map(float, action)
        waypoint = aim((x, y, heading), state.told, state.place, self.task.sensor.body.stride)
        done = self._drive(state, waypoint)
        told = odometry(self.rules.drift, state.place, state.told, done.pose, rng)
        after = RobotState(state.step + 1, done.pose, told, done.v, done.w, self._physics(), done.touched)
        return Step(after, done.length, done.touched and self.rules.collision == "fails", done.reached)

    def shortest(self) -> float:
        """Length of the octile path over cells with room for the body, at most 8.25 % above the shortest one [m]."""
        return way(self, self.start)

    def straight(self) -> float:
        """From start to goal through walls [m]."""
        return hypot(self.task.goal[0] - self.start[0], self.task.goal[1] - self.start[1])

    def covariates(self) -> Mapping[str, float]:
        """Density, detour, dead ends and openness of the cells; see `fogbench.worlds.maps.covariates`."""
        return covariates(self.cells == BLOCKED, self.straight(), self.shortest())

    def remaining(self, state: RobotState) -> float:
        """Length of the octile path from here [m]."""
        return way(self, state.place)

    def known(self) -> RobotMap:
        """The map of a robot that has seen nothing."""
        return RobotMap(self.task)

    def action(self, *numbers: float) -> Waypoint:
        """The waypoint of recorded numbers."""
        return Waypoint(*map(float, numbers))

    def picture(self, known: RobotMap, observation: Observation, path: Sequence[Pose]) -> Picture:
        """A moment from above: walls, beams, the way driven, and the shortest one on the full map."""
        return picture(self, known, observation, path)

    def _at_rest(self) -> Array | None:
        return simulation(self).start(self.start)

    def _physics(self) -> Array | None:
        return simulation(self).state()

    def _drive(self, state: RobotState, waypoint: Pose) -> Drive:
        on = self.rules.collision == "blocked"
        near = self.task.sensor.goal_radius
        return simulation(self).drive(state.physics, state.v, state.w, waypoint, self.task.goal, near, on=on)


class UnicycleWorld(RobotWorld):
    """The same without MuJoCo: a disc that does exactly what its wheels are told."""

    @classmethod
    def side_by_side(cls, slots: int) -> "Batch":
        """A batch of such worlds; it is named by a string, for no episode depends on it."""
        batch: Batch = resolve_name("fogbench.worlds.robot.batch:RobotBatch")(slots)
        return batch

    def _at_rest(self) -> None:
        return None

    def _physics(self) -> None:
        return None

    def _drive(self, state: RobotState, waypoint: Pose) -> Drive:
        outfit: Outfit = self.task.sensor
        body, goal = outfit.body, self.task.goal
        return Drive(
            *drive(
                self.cells, outfit.cell, body.radius, state.place, state.v, state.w,
                waypoint, body.limits, body.ticks, goal, outfit.goal_radius,
            )
        )  # fmt: skip


@lru_cache(maxsize=4)
def simulation(world: RobotWorld) -> Simulation:
    """The model of a world; those of the last few are kept."""
    outfit: Outfit = world.task.sensor
    return Simulation(world.cells, outfit.cell, outfit.body)
