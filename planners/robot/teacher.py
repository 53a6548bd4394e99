"""Who teaches robots: A* with the pilot, on the known map of the robot that learns."""

from math import hypot, remainder, tau

import numpy as np

from fogbench.planners.robot.agent import RobotAgent
from fogbench.planners.robot.choices import CHOICES, ORIGIN, OWN, PLACES, REACH, STEP, TURNS, can_drive
from fogbench.planners.robot.guides import AStarGuide
from fogbench.worlds.robot.driving import ARRIVED, Pose, carried
from fogbench.worlds.types import Array, Observation, Task, Waypoint

TURNED = 0.1
"""Radians: a robot that has turned by more is not stuck, though the pilot did not send it there."""


class RobotTeacher:
    """Follows one robot's known map and tells which choices are nearest to the waypoint that A* would send.

    It teaches and does not judge: with so many choices, one beside the best is no mistake.
    """

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.agent = RobotAgent(task, AStarGuide(task, eager=False))
        self.place: Pose | None = None
        self.waypoint: Waypoint | None = None

    def see(self, observation: Observation) -> None:
        """Look, and plan from where the robot is, as fast as it must be by now."""
        pilot, before = self.agent.pilot, self.place
        self.place = observation.place
        if before is not None:
            pilot.v, pilot.w = self._speeds(before, observation)
            if abs(remainder(self.place[2] - before[2], tau)) > TURNED:
                pilot.stayed = 0
        self.speeds = pilot.v, pilot.w
        self.waypoint = self.agent.act(observation)

    def targets(self) -> Array:
        """Which choices are right: [A] bool.

        Of the four places around the waypoint those that are safe on the known map, or all where none is; of turns the
        two around its heading.
        """
        right = np.zeros(len(CHOICES), np.bool_)
        if self.waypoint is None or self.place is None:
            return right
        x, y, heading = self.waypoint
        ahead, left, turn = carried((x, y, heading), self.place, ORIGIN)
        if hypot(ahead, left) < ARRIVED:
            first = int(turn % tau // (tau / TURNS))
            right[-TURNS:][[first % TURNS, (first + 1) % TURNS]] = True
            return right
        around = _around(ahead, left)
        can = self._can_drive(self.place, around)
        right[around[can] if can.any() else around] = True
        return right

    def _can_drive(self, place: Pose, choices: Array) -> Array:
        """[n] bool, which of some choices are safe on the known map."""
        (_, body, cell, _), can = self.agent.task.sensor, np.empty(len(choices), np.bool_)
        can_drive(
            self.agent.known.cells, cell, body.radius, place, *self.speeds,
            CHOICES[choices], body.stride, body.limits, body.ticks, can,
        )  # fmt: skip
        return can

    def _speeds(self, before: Pose, observation: Observation) -> tuple[float, float]:
        """How fast the robot must be after a decision over which its speed has changed evenly."""
        body = self.agent.task.sensor.body
        if observation.blocked:
            return 0.0, 0.0
        x, y, heading = observation.place
        mean_v = hypot(x - before[0], y - before[1]) / body.decision
        mean_w = remainder(heading - before[2], tau) / body.decision
        v = min(max(2 * mean_v - self.speeds[0], 0.0), body.speed)
        return v, min(max(2 * mean_w - self.speeds[1], -body.turn), body.turn)


def _around(ahead: float, left: float) -> Array:
    """[n] int64, the places, but for the robot's own, at the corners of the square of the grid around a point."""
    row, column = (min(int((axis + REACH) / STEP), PLACES - 2) for axis in (ahead, left))
    corners = (row + np.arange(2))[:, None] * PLACES + column + np.arange(2)
    places: Array = corners[corners != OWN]
    return places - (places > OWN)
