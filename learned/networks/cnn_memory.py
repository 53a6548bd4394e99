"""CNN + Memory: a MACN with four convolutions in the place of its VI module (Khan et al. 2018, section 4)."""

from typing import cast

from torch import Tensor, nn
from torch.nn.functional import pad

from fogbench.learned.cnn_memory import CnnMemory
from fogbench.learned.encoding.grid_inputs import Inputs
from fogbench.learned.layers import convolution
from fogbench.learned.networks.memory import RememberingNetwork

ALIKE = 16
"""Batches are filled up to a multiple: a batch shrinks as its episodes end, and oneDNN prepares for each new size."""


class CnnMemoryNetwork(RememberingNetwork):
    """Convolutions before a memory."""

    def __init__(self, settings: CnnMemory) -> None:
        """Draw the weights."""
        super().__init__(settings, settings.planned)
        shapes = settings.shapes()
        layers = ((convolution(shapes[f"convolutions.{2 * k}.weight"]), nn.ReLU()) for k in range(4))
        self.convolutions = nn.Sequential(*(part for layer in layers for part in layer))

    def plan(self, inputs: Inputs) -> Tensor:
        """The maps of the last layer: [B, 4 * H * W]."""
        batch = len(inputs.image)
        filled = -batch % ALIKE if batch > 1 else 0
        image = pad(inputs.image, (0, 0) * 3 + (0, filled))  # [B + filled, 3, H, W]
        return cast(Tensor, self.convolutions(image))[:batch].flatten(1)
