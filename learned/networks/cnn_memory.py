"""CNN + Memory: a MACN with four convolutions in the place of its VI module (Khan et al. 2018, section 4)."""

from typing import cast

from torch import Tensor

from fogbench.learned.cnn_memory import LAST, Convolving
from fogbench.learned.convolution.convolutions import Convolutions
from fogbench.learned.encoding.grid_sizes import CHANNELS
from fogbench.learned.encoding.images import Images
from fogbench.learned.networks.memory import ImageNetwork


class CnnMemoryNetwork(ImageNetwork):
    """Convolutions before a memory."""

    def __init__(self, settings: Convolving) -> None:
        """Draw the weights."""
        super().__init__(settings, settings.planned)
        self.convolutions = Convolutions(CHANNELS, settings.channels, LAST)

    def plan(self, inputs: Images) -> Tensor:
        """The maps of the last layer: [B, 4 * H * W]."""
        return cast(Tensor, self.convolutions(inputs.image))
