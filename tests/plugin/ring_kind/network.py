"""A network that plays rings."""

from typing import Any

from torch import Tensor, nn

from fogbench import Network
from ring_kind.encoding import NUMBERS, RingEncoding, RingInputs


class RingNetwork(Network):
    """One linear layer."""

    def __init__(self, settings: Any) -> None:
        """Draw the weights."""
        super().__init__()
        del settings
        self.output = nn.Linear(NUMBERS, len(RingEncoding.outputs))

    def blank(self, batch: tuple[int, ...]) -> tuple[()]:
        """Nothing is remembered."""
        del batch
        return ()

    def plan(self, inputs: RingInputs) -> Tensor:
        """What is seen, as it is."""
        image: Tensor = inputs.image
        return image

    def forward(self, inputs: RingInputs, state: Any) -> tuple[Tensor, Any]:
        """The scores of both ways."""
        scores: Tensor = self.output(inputs.image)
        return scores, state
