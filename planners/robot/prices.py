"""What it costs to cross a cell, by the room around it, so that paths keep away from walls as far as there is room.

Words used here
    gap      [H, W] uint16, the room around each cell, see `fogbench.worlds.robot.gaps`
    prices   [n] int32, the price of a cell by its gap; 0: the body has no room there
"""

from functools import lru_cache
from math import sqrt

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.robot.gaps import rings
from fogbench.worlds.robot.known import AROUND, reach
from fogbench.worlds.robot.rules import Outfit
from fogbench.worlds.robot.ways import room_of
from fogbench.worlds.types import Array, Cell

OPEN, NEAR, TIGHT = 4, 6, 48
"""The price of a cell far from walls, what is added close to one, and that of a cell where the body barely fits."""

MARGIN = 0.02
"""Metres between body and wall, beside a fifth of a cell, below which a cell is tight."""

ZONE = 0.5
"""Metres around start and goal where cells count that have as much room as these have."""


@lru_cache(maxsize=16)
def prices_of(outfit: Outfit) -> Array:
    """The prices for a body, of all gaps that its known map tells apart."""
    radius, cell = outfit.body.radius, outfit.cell
    least, safe = room_of(radius, cell), radius + MARGIN + cell / 5
    prices = np.zeros(rings(reach(outfit))[-1, 2] + 2, np.int32)
    for gap in range(least, len(prices)):
        far = sqrt(gap) * cell / 2
        near = max(0.0, 1 - (far - safe) / (radius + AROUND - safe))
        prices[gap] = TIGHT if far < safe else OPEN + round(NEAR * near)
    prices.setflags(write=False)
    return prices


@kernel
def price_of(gap: Array, prices: Array, ends: tuple[Cell, Cell], zone: int, row: int, column: int) -> int:
    """The price of a cell; within `zone` cells of an end that lies too close to a wall, all with its room are tight."""
    price = int(prices[gap[row, column]])
    if price == 0:
        for end in ends:
            near = (row - end[0]) ** 2 + (column - end[1]) ** 2 <= zone * zone
            if near and gap[row, column] >= max(1, gap[end]) and prices[gap[end]] == 0:
                return TIGHT
    return price
