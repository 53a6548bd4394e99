"""Value iteration networks: plan on what is seen and act on Q at the agent's cell (Tamar et al. 2016). No memory."""

from typing import cast

from torch import Tensor

from fogbench.learned.encoding.grid_sizes import CHANNELS
from fogbench.learned.encoding.images import Images, here
from fogbench.learned.layers import linear
from fogbench.learned.networks.network import Network
from fogbench.learned.value_iteration.value_iteration import ValueIteration
from fogbench.learned.vin import Planning, Reacting


class VinNetwork(Network):
    """A VI module, and a linear map of Q at one cell."""

    def __init__(self, settings: Reacting) -> None:
        """Draw the weights."""
        super().__init__()
        self.planner = planner(settings)
        self.output = linear(settings.shapes()["output.weight"], bias=False)

    def blank(self, batch: tuple[int, ...]) -> tuple[()]:
        """Nothing is remembered, whatever the batch."""
        del batch
        return ()

    def forward(self, inputs: Images, state: tuple[()]) -> tuple[Tensor, tuple[()]]:
        """One step."""
        return cast(Tensor, self.output(self.plan(inputs))), state

    def plan(self, inputs: Images) -> Tensor:
        """Q at the agent's cell: [B, 4]."""
        q, _ = self.planner(inputs.image)
        return here(q, inputs.cells)


def planner(settings: Planning) -> ValueIteration:
    """The VI module of some settings, with weights drawn anew."""
    return ValueIteration(CHANNELS, settings.iterations, settings.discount)
