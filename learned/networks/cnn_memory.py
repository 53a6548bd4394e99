"""CNN + Memory: a MACN with four convolutions in the place of its VI module (Khan et al. 2018, section 4)."""

from typing import cast

from torch import Tensor, nn
from torch.nn.functional import pad

from fogbench.learned.cnn_memory import CnnMemory, convolutions
from fogbench.learned.encoding.grid_inputs import Inputs
from fogbench.learned.layers import convolution
from fogbench.learned.networks.memory import RememberingNetwork

ALIKE = 16
"""Batches are filled up to a multiple: a batch shrinks as its episodes end, and oneDNN prepares for each new size."""


class Convolutions(nn.Sequential):
    """Four convolutions, each before a layer that lets nothing negative pass."""

    def __init__(self, channels: int) -> None:
        """Draw the weights."""
        weights = [shape for name, shape in convolutions(channels).items() if name.endswith("weight")]
        super().__init__(*(part for shape in weights for part in (convolution(shape), nn.ReLU())))

    def forward(self, image: Tensor) -> Tensor:
        """From images [B, 3, H, W] to the maps of the last layer, in a row: [B, 4 * H * W]."""
        batch = len(image)
        filled = -batch % ALIKE if batch > 1 else 0
        maps: Tensor = super().forward(pad(image, (0, 0) * 3 + (0, filled)))  # type: ignore[no-untyped-call]
        return maps[:batch].flatten(1)


class CnnMemoryNetwork(RememberingNetwork):
    """Convolutions before a memory."""

    def __init__(self, settings: CnnMemory) -> None:
        """Draw the weights."""
        super().__init__(settings, settings.planned)
        self.convolutions = Convolutions(settings.channels)

    def plan(self, inputs: Inputs) -> Tensor:
        """The maps of the last layer: [B, 4 * H * W]."""
        return cast(Tensor, self.convolutions(inputs.image))
