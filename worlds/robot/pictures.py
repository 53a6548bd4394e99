"""What a moment of a robot looks like from above, in layers; rows grow downwards there, so the map is turned over."""

from collections.abc import Sequence
from math import cos, sin
from typing import TYPE_CHECKING

import numpy as np

from fogbench.worlds.picture import Cells, Dots, Lines, Picture
from fogbench.worlds.robot.driving import Pose
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.robot.rules import Outfit
from fogbench.worlds.robot.ways import shortest_path
from fogbench.worlds.types import Array, Observation

if TYPE_CHECKING:
    from fogbench.worlds.robot.world import RobotWorld

EDGES = 24
"""Of the polygon that stands for the round body."""


def picture(world: "RobotWorld", known: RobotMap, observation: Observation, path: Sequence[Pose]) -> Picture:
    """The walls with the shortest path, the known map, beams, the way driven, body and heading, and the goal."""
    outfit: Outfit = world.task.sensor
    height, width = world.cells.shape
    view = _beams(observation, outfit)

    def drawn(points: Array) -> Array:
        return np.stack([height - points[..., 1] / outfit.cell, points[..., 0] / outfit.cell], -1) - 0.5

    return Picture(
        extent=(float(height), float(width)),
        truth=(Cells(world.cells[::-1].copy()), Lines(drawn(_chain(shortest_path(world))))),
        known=(Cells(known.cells[::-1].copy()),),
        view=Lines(drawn(view)),
        path=Lines(drawn(_chain(np.array([place[:2] for place in path])))),
        agent=Lines(drawn(_body(observation.place, outfit.body.radius))),
        goal=Dots(drawn(np.array([world.task.goal]))),
    )


def _chain(points: Array) -> Array:
    """Lines [n - 1, 2, 2] from each point to the next."""
    return np.stack([points[:-1], points[1:]], 1)


def _beams(observation: Observation, outfit: Outfit) -> Array:
    """Lines [R, 2, 2] from the robot to the end of each beam [m]."""
    x, y, heading = observation.place
    beams = (np.arange(len(observation.view)) + 0.5) / len(observation.view) - 0.5  # [R]
    angles = heading + outfit.lidar.arc * beams
    ends = np.stack([np.cos(angles), np.sin(angles)], -1) * observation.view[:, None] + (x, y)  # [R, 2]
    return np.stack([np.broadcast_to((x, y), ends.shape), ends], 1)


def _body(place: Pose, radius: float) -> Array:
    """Lines [EDGES + 1, 2, 2] around the body, and from its middle to its front [m]."""
    x, y, heading = place
    angles = heading + np.linspace(0, 2 * np.pi, EDGES + 1)  # [EDGES + 1]
    skin = np.stack([x + radius * np.cos(angles), y + radius * np.sin(angles)], -1)
    nose = np.array([[[x, y], [x + radius * cos(heading), y + radius * sin(heading)]]])
    return np.concatenate([_chain(skin), nose])
