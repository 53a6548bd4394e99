"""What a robot has seen of its walls: the one known map of planners, networks, judges and replays.

*The latest reading of a cell wins; the cell that the robot is in is free.* A beam frees all cells that it crosses and
blocks the cell just behind the point where it ends, unless it has met nothing; within one scan, blocked wins.
"""

from math import ceil

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.gaps import gaps, keep_up, rings
from fogbench.worlds.robot.lidar import bearing, ray
from fogbench.worlds.robot.rules import Outfit, shape_of
from fogbench.worlds.types import BLOCKED, FREE, Array, Observation, Task

AROUND = 0.3
"""Metres beyond the body up to which gaps are told apart."""

BEHIND = 1e-5
"""How far behind the end of a beam the cell lies that it has met [cells]; float32 rounds less than that."""

MET = 3
"""A cell that a beam of the present scan has met."""


class RobotMap:
    """The walls as far as one robot has seen them."""

    def __init__(self, task: Task) -> None:
        """Nothing is known yet but the border."""
        self.outfit: Outfit = task.sensor
        self.cells: Array = np.zeros(shape_of(task), np.uint8)  # [H, W], UNKNOWN
        self.gap: Array = gaps(self.cells, rings(reach(self.outfit)))  # [H, W]

    def update(self, observation: Observation) -> Array:
        """Write a scan into the map.

        Returns:
            [n] int64, flat indices of the cells whose gap has changed; one may be there more than once.
        """
        touched = fuse_scan(self.cells, observation, self.outfit)
        return keep_up(self.cells, self.gap, rings(reach(self.outfit)), touched)


def reach(outfit: Outfit) -> int:
    """How far gaps are told apart on a known map [half cells]."""
    return ceil(2 * (outfit.body.radius + AROUND) / outfit.cell)


def fuse_scan(cells: Array, observation: Observation, outfit: Outfit) -> Array:
    """Write a scan into a map of cells.

    Returns:
        [n] int64, flat indices of the cells that came to be blocked, or are so no longer.
    """
    (x, y, heading), cell, lidar = observation.place, outfit.cell, outfit.lidar
    return fuse(cells, observation.view, x / cell, y / cell, heading, lidar.arc, lidar.range, cell)


@kernel
def fuse(
    cells: Array, ranges: Array, x: float, y: float, heading: float, field: float, most: float, cell: float
) -> Array:
    """Write ranges [R] float32 [m], seen from a point [cells], into a map; 0 tells nothing, `most` [m] met nothing.

    Returns:
        As `fuse_scan`.
    """
    height, width = cells.shape
    own = int(y) * width + int(x)
    met, touched = [own], [own]  # the first of each only tells its type
    for beam in range(len(ranges)):
        if not 0 < ranges[beam] < most:
            continue
        angle = heading + bearing(beam, len(ranges), field)
        end = ranges[beam] / cell + BEHIND
        row, column = int(np.floor(y + end * np.sin(angle))), int(np.floor(x + end * np.cos(angle)))
        flat = row * width + column
        if 0 <= row < height and 0 <= column < width and flat != own and cells[row, column] != MET:
            if cells[row, column] != BLOCKED:
                touched.append(flat)
            cells[row, column] = MET
            met.append(flat)
    for beam in range(len(ranges)):
        angle = heading + bearing(beam, len(ranges), field)
        _free(cells, x, y, angle, max(ranges[beam] / cell - BEHIND, 0.0), touched)
    for flat in met[1:]:
        cells[flat // width, flat % width] = BLOCKED
    return np.array(touched[1:], np.int64)


@kernel
def _free(cells: Array, x: float, y: float, angle: float, end: float, touched: list[int]) -> None:
    """Free the cells that a beam crosses before its end, but for those that were met; note which were blocked."""
    height, width = cells.shape
    row, column, next_row, next_column, each_row, each_column, to_row, to_column = ray(x, y, angle)
    way = 0.0
    while way <= end and 0 <= row < height and 0 <= column < width:
        if cells[row, column] == BLOCKED:
            touched.append(row * width + column)
        if cells[row, column] != MET:
            cells[row, column] = FREE
        if to_column < to_row:
            way, column = to_column, column + next_column
            to_column += each_column
        else:
            way, row = to_row, row + next_row
            to_row += each_row
