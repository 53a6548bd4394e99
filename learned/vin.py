"""Value iteration networks: plan on what is seen and act on Q at the agent's cell (Tamar et al. 2016). No memory.

With `stitched: true` it plans on the map known so far (Khan et al. 2018, appendix B.1).
"""

from typing import Annotated, cast

from pydantic import Field
from torch import Tensor, nn

from fogbench.learned.encoding.grid import CHANNELS, Inputs
from fogbench.learned.network import Network
from fogbench.learned.policy import Policy
from fogbench.learned.value_iteration.sizes import ACTIONS
from fogbench.learned.value_iteration.value_iteration import ValueIteration
from fogbench.worlds.settings import Probability


class Planning(Policy):
    """A policy with a VI module."""

    iterations: Annotated[int, Field(ge=1, le=1000)] = 16
    """K of the VI module."""
    discount: Probability | None = None
    """None leaves the value's kernels free, as in the paper; a number makes each a distribution times it."""

    def planner(self) -> ValueIteration:
        """A VI module with weights drawn anew."""
        return ValueIteration(CHANNELS, self.iterations, self.discount)


class Vin(Planning):
    """VIN: value iteration on what the sensor shows, or on the stitched map, and nothing else."""

    def network(self) -> "VinNetwork":
        """A network with weights drawn anew."""
        return VinNetwork(self)


class VinNetwork(Network):
    """A VI module, and a linear map of Q at one cell."""

    def __init__(self, settings: Vin) -> None:
        """Draw the weights."""
        super().__init__()
        self.planner = settings.planner()
        self.output = nn.Linear(ACTIONS, ACTIONS, bias=False)

    def blank(self, batch: tuple[int, ...]) -> tuple[()]:
        """Nothing is remembered, whatever the batch."""
        del batch
        return ()

    def forward(self, inputs: Inputs, state: tuple[()]) -> tuple[Tensor, tuple[()]]:
        """One step."""
        return cast(Tensor, self.output(self.plan(inputs))), state

    def plan(self, inputs: Inputs) -> Tensor:
        """Q at the agent's cell: [B, 4]."""
        q, _ = self.planner(inputs.image)
        return inputs.here(q)
