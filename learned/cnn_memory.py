"""CNN + Memory: a MACN with four convolutions in the place of its VI module (Khan et al. 2018, section 4)."""

from itertools import pairwise
from typing import cast

from torch import Tensor, nn
from torch.nn.functional import pad

from fogbench.learned.encoding.grid import CHANNELS, Inputs
from fogbench.learned.memory import Remembering, RememberingNetwork
from fogbench.learned.policy import Size
from fogbench.learned.value_iteration.sizes import ACTIONS

ALIKE = 16
"""Batches are filled up to a multiple: a batch shrinks as its episodes end, and oneDNN prepares for each new size."""


class CnnMemory(Remembering):
    """CNN + Memory: four convolutions on what the sensor shows, then a DNC, an LSTM or no memory."""

    channels: Size = 32
    """Of the first three convolutions; the last has as many as there are moves, like Q."""

    def network(self) -> "CnnMemoryNetwork":
        """A network with weights drawn anew."""
        return CnnMemoryNetwork(self)


class CnnMemoryNetwork(RememberingNetwork):
    """Convolutions before a memory."""

    def __init__(self, settings: CnnMemory) -> None:
        """Draw the weights."""
        rows, columns = settings.size
        super().__init__(settings, ACTIONS * rows * columns)
        widths = CHANNELS, *[settings.channels] * 3, ACTIONS
        layers = ((nn.Conv2d(before, after, 3, padding=1), nn.ReLU()) for before, after in pairwise(widths))
        self.convolutions = nn.Sequential(*(part for layer in layers for part in layer))

    def plan(self, inputs: Inputs) -> Tensor:
        """The maps of the last layer: [B, 4 * H * W]."""
        batch = len(inputs.image)
        filled = -batch % ALIKE if batch > 1 else 0
        image = pad(inputs.image, (0, 0) * 3 + (0, filled))  # [B + filled, 3, H, W]
        return cast(Tensor, self.convolutions(image))[:batch].flatten(1)
