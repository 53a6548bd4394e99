"""What a lidar shows, by exact ray casting on cells.

Words used here
    cells    [H, W] uint8 of UNKNOWN, FREE, BLOCKED, row 0 at the bottom; everything outside it is blocked
    x, y     a point in cells from the lower left corner: it lies in column floor(x) and row floor(y)
    R        beams
"""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.driving import Pose
from fogbench.worlds.robot.rules import Lidar
from fogbench.worlds.types import BLOCKED, Array


@kernel
def bearing(beam: int, beams: int, field: float) -> float:
    """The angle of a beam from the heading, counterclockwise [rad]; `field` [rad] is cut into equal parts."""
    return field * ((beam + 0.5) / beams - 0.5)


@kernel
def cast(cells: Array, cell: float, pose: Pose, field: float, most: float, ranges: Array) -> None:
    """Write what all beams truly measure into `ranges` [R]: the way to the first blocked cell, or `most`.

    Args:
        cells: a map.
        cell: side of its cells [m].
        pose: inside of the map [m, m, rad].
        field: that the beams are spread over [rad].
        most: [m]
        ranges: [m]
    """
    for beam in range(len(ranges)):
        angle = pose[2] + bearing(beam, len(ranges), field)
        ranges[beam] = min(cell * cast_one(cells, pose[0] / cell, pose[1] / cell, angle, most / cell), most)


@kernel
def cast_one(cells: Array, x: float, y: float, angle: float, most: float) -> float:
    """What one beam measures [cells]."""
    height, width = cells.shape
    row, column, next_row, next_column, each_row, each_column, to_row, to_column = ray(x, y, angle)
    while True:
        if to_column < to_row:
            way, column = to_column, column + next_column
            to_column += each_column
        else:
            way, row = to_row, row + next_row
            to_row += each_row
        if way >= most:
            return most
        if not (0 <= row < height and 0 <= column < width) or cells[row, column] == BLOCKED:
            return way


@kernel
def ray(x: float, y: float, angle: float) -> tuple[int, int, int, int, float, float, float, float]:
    """A beam before its first step from cell to cell (Amanatides & Woo 1987); at a corner it goes on by rows.

    Returns:
        The row and the column that it is in, what a step adds to each, the way between two rows and two columns, and
        the way to the next row and the next column [cells].
    """
    right, up = np.cos(angle), np.sin(angle)
    row, column = int(np.floor(y)), int(np.floor(x))
    each_row, each_column = 1 / max(abs(up), 1e-300), 1 / max(abs(right), 1e-300)
    to_row = (row + 1 - y if up > 0 else y - row) * each_row
    to_column = (column + 1 - x if right > 0 else x - column) * each_column
    return row, column, 1 if up > 0 else -1, 1 if right > 0 else -1, each_row, each_column, to_row, to_column


def misread(ranges: Array, lidar: Lidar, rng: np.random.Generator) -> Array:
    """What is told of true ranges [R]: with noise, and 0 of dropped beams; all is drawn, whatever the truth.

    Returns:
        [R] float32, from 0 to the lidar's range [m].
    """
    told = ranges
    if lidar.noise:
        shifted = ranges + lidar.noise * rng.standard_normal(len(ranges))
        told = np.where(ranges < lidar.range, np.clip(shifted, 1e-3, lidar.range), ranges)
    if lidar.dropped:
        told = np.where(rng.random(len(ranges)) < lidar.dropped, 0.0, told)
    return told.astype(np.float32)
