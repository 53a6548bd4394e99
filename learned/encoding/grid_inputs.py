"""From what agents on grids know to what a network sees; one implementation for single decisions and for batches.

Words used here
    B      samples
    cells  [B, h, w] uint8 of UNKNOWN, FREE, BLOCKED: views, or known maps, with their top left cells at `corners`
    image  [B, 3, H, W] what the VI module plans on: known to be free, known to be blocked, the goal
    sight  [B, 3, S, S] the same of the cells around the agent, S = 2 * SIGHT + 1
    compass  [B, COMPASS] where the goal is, and what the last move did

An image is a window around the agent, or the whole map (`Frame`). A goal outside it is moved to its nearest cell.
"""

from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.encoding.grid_sizes import CHANNELS, COMPASS, SIGHT, Frame
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array

HORIZON = 64
"""Cells; how much farther off a goal lies is not told, so that no number grows with the map beyond all that a network
learned from (as relative positions are clipped in Shaw et al. 2018, section 3.2)."""

STILL = 4
"""In the place of the last move before the first."""


class Known(NamedTuple):
    """What some agents know at one step, as arrays."""

    cells: Array
    """[B, h, w] uint8."""
    corners: Array
    """[B, 2] int64, row and column on the map of the first of `cells`."""
    places: Array
    """[B, 2] int64, the agents' cells."""
    goals: Array
    """[B, 2] int64."""
    moves: Array
    """[B] int64, the last move, STILL before the first."""
    blocked: Array
    """[B] bool, whether an obstacle stopped it."""


class Inputs(NamedTuple):
    """What a network sees, for a batch."""

    image: Tensor
    """[B, 3, H, W] float32."""
    cells: Tensor
    """[B] int64, where the agents are in the image: row * W + column."""
    sight: Tensor
    """[B, 3, S, S] float32."""
    compass: Tensor
    """[B, COMPASS] float32."""

    def to(self, device: str) -> "Inputs":
        """The same on a device."""
        return self if self.image.device.type == device else Inputs(*(part.to(device) for part in self))

    @property
    def beside(self) -> tuple[Tensor, Tensor]:
        """What a memory is told as it is: [B, SEEN] and [B, COMPASS]."""
        return self.sight.flatten(1), self.compass


def encode(known: Known, frame: Frame) -> Inputs:
    """What a network sees of what some agents know."""
    batch, side = len(known.places), 2 * SIGHT + 1
    middle = np.array(frame.shape, np.int64) // 2
    origins = known.places - middle if frame.centred else np.zeros_like(known.places)  # [B, 2]
    image = np.zeros((batch, CHANNELS, *frame.shape), np.float32)
    sight = np.zeros((batch, CHANNELS, side, side), np.float32)
    compass = np.zeros((batch, COMPASS), np.float32)
    draw(known.cells, known.corners, known.places, known.goals, origins, image)
    draw(known.cells, known.corners, known.places, known.goals, known.places - SIGHT, sight)
    point(known.places, known.goals, known.moves, known.blocked, compass)
    cells = (known.places - origins) @ (frame.shape[1], 1)  # [B]
    return Inputs(*map(torch.from_numpy, (image, cells, sight, compass)))


@kernel
def draw(cells: Array, corners: Array, places: Array, goals: Array, origins: Array, image: Array) -> None:
    """Draw what is known, and the goal, into images of zeros whose first cells are at `origins` [B, 2] on the map.

    The agent's own cell is free, whatever the sensor says of it, as in the known map.
    """
    height, width = image.shape[2:]
    for b in range(len(image)):
        top, left = corners[b, 0] - origins[b, 0], corners[b, 1] - origins[b, 1]
        for r in range(max(0, -top), min(cells.shape[1], height - top)):
            for c in range(max(0, -left), min(cells.shape[2], width - left)):
                reading = cells[b, r, c]
                if reading != UNKNOWN:
                    image[b, reading - FREE, top + r, left + c] = 1
        row, column = places[b, 0] - origins[b, 0], places[b, 1] - origins[b, 1]
        image[b, 0, row, column] = 1
        image[b, BLOCKED - FREE, row, column] = 0
        row = min(max(goals[b, 0] - origins[b, 0], 0), height - 1)
        column = min(max(goals[b, 1] - origins[b, 1], 0), width - 1)
        image[b, 2, row, column] = 1


@kernel
def point(places: Array, goals: Array, moves: Array, blocked: Array, compass: Array) -> None:
    """Fill compasses of zeros."""
    for b in range(len(compass)):
        for axis in range(2):
            offset = goals[b, axis] - places[b, axis]
            compass[b, axis] = np.sign(offset)
            compass[b, 2 + axis] = np.log1p(min(abs(offset), HORIZON))
            compass[b, 4 + axis] = min(max(offset, -SIGHT), SIGHT) / SIGHT
        compass[b, 6 + moves[b]] = 1
        compass[b, 11] = blocked[b]
