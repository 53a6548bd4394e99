"""HFN: human-friendly navigation (Guzzi et al. 2013) by the package navground, towards points of a path of A*.

The behaviour looks for the heading from which the way to its target is shortest, as far as the sensor sees free space,
and slows down so that it can always stop in time. It is local, so A* on the known map tells it where to go.
"""

from math import cos, hypot, sin
from typing import Annotated, ClassVar, cast

import numpy as np
from navground.core import Disc, GeometricState, Pose2, Target, Twist2
from navground.core.behaviors import HLBehavior
from navground.core.kinematics import TwoWheelsDifferentialDriveKinematics
from pydantic import Field

from fogbench.planners.robot.agent import RobotAgent, glance, points
from fogbench.planners.robot.guides import AStarGuide
from fogbench.planners.robot.pilot import in_sight
from fogbench.worlds.robot.driving import Pose
from fogbench.worlds.robot.lidar import bearing
from fogbench.worlds.robot.simulation import TRACK
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import Array, Observation, Task, Waypoint

AHEAD, STEP = 1.0, 0.1
"""Seconds that the behaviour is rolled ahead for a waypoint, and those between two of its commands."""

REACH = 3.0
"""Metres in which walls and points of the path count."""

SHORT = 0.25
"""Metres: where the behaviour would not come farther, it is held up."""

POINT = 0.02
"""Radius of the disc that stands for the end of a beam [m]."""


class HFN(Settings):
    """Human-friendly navigation towards points of a path of A*."""

    kinds: ClassVar[frozenset[str]] = frozenset({"robot"})

    safety_margin: Annotated[float, Field(ge=0, le=1)] = 0.08
    """Metres that it keeps from what it sees, where there is room."""

    def start(self, task: Task, rng: np.random.Generator) -> "HFNAgent":
        """A fresh agent; it needs no luck."""
        del rng
        return HFNAgent(task, self.safety_margin)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class HFNAgent(RobotAgent):
    """One episode of human-friendly navigation; where it is held up or not safe, the path is driven."""

    def __init__(self, task: Task, margin: float) -> None:
        """Nothing is known yet."""
        super().__init__(task, AStarGuide(task, eager=False))
        self.margin = margin

    def act(self, observation: Observation) -> Waypoint | None:
        """The next waypoint."""
        touched = self.known.update(observation)
        path = self.guide.path(self.known, observation.place, touched)
        if not len(path):
            path = glance(self.task, self.guide, observation)
        if not len(path):
            return None
        way = points(self.task, path)
        place, wish = observation.place, self._ahead(observation, self._target(observation.place, way))
        moves = hypot(wish[0] - place[0], wish[1] - place[1]) > SHORT
        return self.pilot.waypoint(self.known.cells, place, way, wish if moves else None)

    def _target(self, pose: Pose, way: Array) -> Array:
        """The last point of a path that is in sight and in reach."""
        outfit, near = self.known.outfit, np.flatnonzero(np.hypot(*(way - pose[:2]).T) <= REACH)
        for k in near[::-2].tolist():
            if in_sight(self.known.cells, outfit.cell, outfit.body.radius, pose, way[k, 0], way[k, 1]):
                return np.asarray(way[k])
        return np.asarray(way[min(len(way) - 1, 3)])

    def _ahead(self, observation: Observation, target: Array) -> Pose:
        """Where the behaviour would be after a while."""
        body, (x, y, heading) = self.known.outfit.body, observation.place
        wheels = TwoWheelsDifferentialDriveKinematics(body.speed, TRACK * body.radius, body.turn)
        behavior = HLBehavior(wheels, body.radius)
        behavior.safety_margin, behavior.horizon, behavior.optimal_speed = self.margin, REACH, body.speed
        behavior.pose = Pose2((x, y), heading)
        speed = self.pilot.v
        behavior.twist = Twist2((speed * cos(heading), speed * sin(heading)), self.pilot.w)
        seen = cast(GeometricState, behavior.environment_state)
        seen.static_obstacles = [Disc(point, POINT) for point in self._met(observation)]
        behavior.target = Target(position=target)
        for _ in range(round(AHEAD / STEP)):
            behavior.compute_cmd(STEP)
            behavior.actuate(STEP)
        return float(behavior.position[0]), float(behavior.position[1]), float(behavior.orientation)

    def _met(self, observation: Observation) -> Array:
        """[n, 2] float64, the ends of the beams that have met something in reach [m]."""
        lidar, (x, y, heading), ranges = self.known.outfit.lidar, observation.place, observation.view
        angles = heading + np.array([bearing(beam, len(ranges), lidar.arc) for beam in range(len(ranges))])  # [R]
        ends = np.stack([x + ranges * np.cos(angles), y + ranges * np.sin(angles)], -1)
        met: Array = ends[(ranges > 0) & (ranges < min(lidar.range, REACH))]
        return met
