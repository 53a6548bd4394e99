"""Memory augmented control networks: plan on what is seen, remember, decide (Khan et al. 2018, section 3 and figure 2).

The controller gets the values, and low-level features of what is seen (section 2.4), which here are convolutions of it.
How the values enter the controller is not said there. Here they come relative to the agent's own, since what matters is
where they are higher; with them comes Q at the agent's cell.
"""

import torch
from torch import Tensor

from fogbench.learned.cnn_memory import LAST
from fogbench.learned.convolution.convolutions import Convolutions
from fogbench.learned.encoding.grid_inputs import Inputs
from fogbench.learned.encoding.grid_sizes import CHANNELS
from fogbench.learned.encoding.images import Images, here
from fogbench.learned.macn import Macn, PlanningAndRemembering
from fogbench.learned.networks.macn_single import Weights, in_lanes, see
from fogbench.learned.networks.memory import ImageNetwork
from fogbench.learned.networks.vin import planner


class PlanningNetwork(ImageNetwork):
    """A VI module before a memory."""

    def __init__(self, settings: PlanningAndRemembering, beside: int = 0) -> None:
        """Draw the weights; `beside` is how many numbers `made` gives beside the plan."""
        super().__init__(settings, settings.planned + beside)
        self.planner = planner(settings)

    def plan(self, inputs: Images) -> Tensor:
        """The values of all cells and of all moves, relative to the agent's cell: [B, H * W + 4]."""
        q, v = self.planner(inputs.image)
        own = here(q, inputs.cells)  # [B, 4], of which the largest is V there
        return torch.cat([v.flatten(1), own], 1) - own.amax(1, keepdim=True)


class MacnNetwork(PlanningNetwork):
    """A VI module, and convolutions beside it, before a memory."""

    def __init__(self, settings: Macn) -> None:
        """Draw the weights."""
        super().__init__(settings, settings.convolved)
        channels = settings.channels
        self.convolutions = Convolutions(CHANNELS, channels, LAST) if channels else None
        self.settled: Weights | None = None

    @torch.no_grad()
    def settle(self) -> None:
        """Get ready for single steps without gradients: from now on the weights must not change."""
        if self.features is not None and self.features.weight.is_cpu:
            layers = *self.planner.reward_map.collapsed(), self.planner.normalised(), *self.features.parameters()
            rewards, reward_bias, kernels, features, bias = (weight.contiguous() for weight in layers)
            beside = [] if self.convolutions is None else list(self.convolutions.parameters())
            self.settled = Weights(rewards, reward_bias, kernels, features, bias, *in_lanes(beside))

    def see(self, inputs: Inputs) -> Tensor:
        """As for all, for one sample in one call."""
        if self.settled and len(inputs.image) == 1:
            return see(self.settled, self.planner.iterations, inputs)
        return super().see(inputs)

    def made(self, inputs: Inputs) -> tuple[Tensor, ...]:
        """The values, and the maps of the last convolution."""
        beside = () if self.convolutions is None else (self.convolutions(inputs.sight),)
        return self.plan(inputs), *beside
