"""Who decides in the episodes that a network learns from: itself by chance, or the teacher; and noise in its memory."""

from typing import Any

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.networks.network import Network
from fogbench.learned.training.rollout import Turn
from fogbench.worlds.types import Array


class Explorer:
    """Decides while training: in some episodes the teacher, in the others the network, by chance.

    Where the network would run into an obstacle that is in view, the teacher decides too.
    """

    def __init__(self, luck: np.random.Generator, episodes: int, share: float) -> None:
        """Draw which of the episodes, `share` of them on average, are the teacher's."""
        self.luck = luck
        self.led = luck.random(episodes) < share

    def __call__(self, turn: Turn) -> Array:
        """The outputs [b]; the teacher takes any of the right ones."""
        chances = self.luck.random((2, len(self.led)))[:, turn.episodes]  # [2, b]
        own = pick(np.exp(turn.scores - turn.scores.max(1, keepdims=True)), chances[0])
        blocked = ~np.take_along_axis(turn.open, own[:, None], 1)[:, 0]
        led = (self.led[turn.episodes] | blocked) & turn.targets.any(1)
        outputs: Array = np.where(led, pick(turn.targets, chances[1]), own)
        return outputs


class Noisy(Network):
    """A network whose controller's output is remembered with noise."""

    def __init__(self, network: Network, deviation: float, seed: int) -> None:
        """Share the weights of `network`."""
        super().__init__()
        self.network = network
        self.deviation = deviation
        self.luck = torch.Generator().manual_seed(seed)

    def blank(self, batch: tuple[int, ...]) -> Any:
        """The network's."""
        return self.network.blank(batch)

    def forward(self, inputs: Any, state: Any) -> tuple[Tensor, Any]:
        """One step."""
        scores, state = self.network(inputs, state)
        if hasattr(state, "hidden"):
            noise = torch.randn(state.hidden.shape, generator=self.luck).to(state.hidden.device)
            state = state._replace(hidden=state.hidden + self.deviation * noise)
        return scores, state


def pick(weights: Array, chances: Array) -> Array:
    """For each row of `weights` [b, A] a column, as likely as it weighs; `chances` [b] are uniform in [0, 1)."""
    sums = weights.cumsum(1)  # [b, A]
    columns: Array = (sums > chances[:, None] * sums[:, -1:]).argmax(1)
    return columns
