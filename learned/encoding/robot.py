"""What a network sees of a robot's world: what is kept of an episode, how it becomes tensors, what its outputs mean."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from fogbench.learned.encoding.robot_inputs import RobotInputs, Told, body_of, encode, open_choices
from fogbench.planners.robot.choices import CHOICES, NAMES, ORIGIN, chosen
from fogbench.worlds.robot.driving import Pose, speeds_after
from fogbench.worlds.robot.rules import Outfit
from fogbench.worlds.types import Array, Observation, Task, Waypoint


class Shown(Protocol):
    """What the settings of a policy say of what it is shown; see `fogbench.learned.robot_policy.RobotPolicy`."""

    @property
    def window(self) -> int:
        """Rows and columns of the image."""

    @property
    def cell(self) -> float:
        """Side of its cells [m]."""


class RobotViewpoint:
    """What is kept of an episode: the last pose and choice, how fast the robot drives; a look until the decision."""

    observation: Observation
    """Of the look that no decision has followed yet."""
    bytes = 0

    def __init__(self, task: Task) -> None:
        """Standing still, and nothing is seen yet."""
        self.goal: tuple[float, float] = task.goal
        self.outfit: Outfit = task.sensor
        self.body = body_of(task.sensor, task.extent)
        self.before: Pose | None = None
        self.speeds, self.last = (0.0, 0.0), ORIGIN

    def see(self, observation: Observation) -> None:
        """Look; who was stopped stands."""
        self.observation = observation
        self.before = self.before or observation.place
        if observation.blocked:
            self.speeds = 0.0, 0.0

    def act(self, output: int) -> Waypoint:
        """The waypoint of a choice; nothing of the look is carried on but the pose."""
        body, place = self.outfit.body, self.observation.place
        waypoint = chosen(CHOICES, output, place, body.stride)
        self.speeds = speeds_after(place, *self.speeds, waypoint, body.limits, body.ticks)
        self.before, self.last = place, tuple(CHOICES[output].tolist())
        del self.observation
        return Waypoint(*waypoint)


class RobotEncoding:
    """The scan as an image of what lies ahead, its sectors, and a compass; the outputs are places and turns."""

    outputs = NAMES

    def __init__(self, settings: Shown) -> None:
        """Show what the settings say."""
        self.window, self.cell = settings.window, settings.cell

    def start(self, task: Task) -> RobotViewpoint:
        """A viewpoint from which nothing was seen."""
        return RobotViewpoint(task)

    def encode(self, viewpoints: Sequence[RobotViewpoint]) -> RobotInputs:
        """What a network sees from some viewpoints."""
        return encode(gather(viewpoints), self.window, self.cell)

    def open(self, inputs: RobotInputs) -> Array:
        """[B, A] bool, the choices that the scan does not show blocked; turns on the spot, which brake, always are."""
        return open_choices(inputs)


def gather(viewpoints: Sequence[RobotViewpoint]) -> Told:
    """What is told at some viewpoints, by lidars of any numbers of beams."""
    looks = [viewpoint.observation for viewpoint in viewpoints]
    ranges = np.zeros((len(looks), max(len(look.view) for look in looks)), np.float32)
    for row, look in zip(ranges, looks, strict=True):
        row[: len(look.view)] = look.view
    poses, blocked = [look.place for look in looks], [look.blocked for look in looks]
    columns = zip(*((each.before, each.speeds, each.last, each.goal, each.body) for each in viewpoints), strict=True)
    before, speeds, last, goals, bodies = (np.array(column, np.float64) for column in columns)
    return Told(ranges, np.array(poses, np.float64), before, speeds, last, goals, np.array(blocked), bodies)
