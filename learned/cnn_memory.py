"""Settings of CNN + Memory: a MACN with four convolutions in the place of its VI module (Khan et al. 2018)."""

from math import prod
from typing import ClassVar

from fogbench.learned.convolution.sizes import shapes
from fogbench.learned.encoding.grid_sizes import CHANNELS, OUTPUTS
from fogbench.learned.grid_policy import GridPolicy
from fogbench.learned.memory import Remembering
from fogbench.learned.policy import Size
from fogbench.learned.shapes import Shapes, parts

LAST = len(OUTPUTS)
"""Channels of the last convolution: as many as there are moves, like Q."""


class Convolving(Remembering):
    """Four convolutions before a memory; a subclass says what it sees and does."""

    made_of: ClassVar[str] = "fogbench.learned.networks.cnn_memory:CnnMemoryNetwork"

    channels: Size = 32
    """Of the first three convolutions."""

    @property
    def planned(self) -> int:
        """Numbers from the last convolution."""
        return LAST * prod(self.plane)

    def shapes(self) -> Shapes:
        """Those of the convolutions before a memory."""
        return self.remembering_shapes(self.planned) | parts(convolutions=shapes(CHANNELS, self.channels, LAST))


class CnnMemory(GridPolicy, Convolving):
    """CNN + Memory: four convolutions on what the sensor shows, then a DNC, an LSTM, a GRU or no memory."""
