"""How far the goal of a robot is on the full map: over cells with room for the body."""

from functools import lru_cache
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from fogbench.worlds.robot.driving import Pose
from fogbench.worlds.robot.gaps import gaps, rings
from fogbench.worlds.robot.known import reach
from fogbench.worlds.robot.octile import FAR, SIDE, STEPS, lengths
from fogbench.worlds.robot.rules import Outfit
from fogbench.worlds.types import Array, Cell

if TYPE_CHECKING:
    from fogbench.worlds.robot.world import RobotWorld

AROUND = 3
"""Cells around a robot among which the nearest to the goal counts where its own has no room."""


def cell_at(place: tuple[float, ...], cell: float) -> Cell:
    """The row and column of a point (x, y, ...) [m] on cells of a side [m]."""
    return int(place[1] / cell), int(place[0] / cell)


def room_of(radius: float, cell: float) -> int:
    """The gap that a cell must have, so that a disc of a radius [m] around its middle touches no wall."""
    return ceil((2 * radius / cell) ** 2 - 1e-9)


@lru_cache(maxsize=4)
def to_goal(world: "RobotWorld") -> Array:
    """[H, W] int32, lengths to the goal, of which SIDE is a cell; those of the last few worlds are kept."""
    outfit: Outfit = world.task.sensor
    gap = gaps(world.cells, rings(reach(outfit)))
    return lengths(gap, room_of(outfit.body.radius, outfit.cell), cell_at(world.task.goal, outfit.cell))


def way(world: "RobotWorld", place: Pose) -> float:
    """Length of the octile path from a place [m]; infinite where none leads from its cell or those around it."""
    length, cell = to_goal(world), world.task.sensor.cell
    row, column = cell_at(place, cell)
    left = int(length[row, column])
    if left == FAR:
        left = int(length[max(0, row - AROUND) : row + AROUND + 1, max(0, column - AROUND) : column + AROUND + 1].min())
    return float("inf") if left == FAR else left * cell / SIDE


def shortest_path(world: "RobotWorld") -> Array:
    """[n, 2] float64, the octile path from start to goal: the middles of its cells [m]."""
    length, cell = to_goal(world), world.task.sensor.cell
    row, column = cell_at(world.start, cell)
    path = [(column, row)]
    while length[row, column]:
        steps = ((row + down, column + right, cost) for down, right, cost in STEPS)
        row, column = next(
            (r, c)
            for r, c, cost in steps
            if 0 <= r < len(length) and 0 <= c < length.shape[1] and length[r, c] == length[row, column] - cost
        )
        path.append((column, row))
    middles: Array = (np.array(path) + 0.5) * cell
    return middles
