"""MACN on the graph explored so far: a reward at each node to explore, values, a memory, a word to each neighbour.

Words used here
    B, P, K    samples, nodes and neighbours of all of them, as in `fogbench.learned.encoding.explored_inputs`
    A          outputs
"""

from typing import Any

import torch
from torch import Tensor, nn
from torch.nn.functional import softplus

from fogbench.learned.encoding.explored_inputs import ExploredInputs
from fogbench.learned.layers import linear
from fogbench.learned.macn_explored import PLANNED, MacnExplored
from fogbench.learned.networks.memory import RememberingNetwork
from fogbench.learned.shapes import Shapes
from fogbench.learned.value_iteration.explored import ends_of

LEAST = 1e-3
"""What a step costs at least, so that the nearer of equals is better."""

WORST = -10.0
"""How much worse than the best a way can be told to be."""


class ExploredNetwork(RememberingNetwork):
    """Plans on what is known, as far as it was explored; a memory says what to make of the plan."""

    def __init__(self, settings: MacnExplored) -> None:
        """Draw the weights."""
        super().__init__(settings, PLANNED)
        shapes = settings.shapes()
        self.most = settings.most
        self.step, self.trust = nn.Parameter(torch.zeros(1)), nn.Parameter(torch.ones(1))
        self.rewards, self.scores = Perceptron(shapes, "rewards"), Perceptron(shapes, "scores")

    def forward(self, inputs: ExploredInputs, state: Any) -> tuple[Tensor, Any]:
        """One step; an output that is no neighbour has the score -inf."""
        gains, best = self.ways(inputs)
        seen = torch.cat([best[:, None], inputs.told], 1)
        words, state = self.memory.step(self.told(seen), state)
        told = torch.cat([inputs.traits, gains[:, None]], 1)
        scores = self.scores(told, words[inputs.owners]) + self.trust * gains
        table = scores.new_full((len(best), self.most), -torch.inf)
        columns = inputs.neighbours - inputs.nodes[inputs.owners]
        return table.index_put((inputs.owners, columns), scores), state

    def plan(self, inputs: ExploredInputs) -> Tensor:
        """-log V of the best neighbour: [B, 1]."""
        return self.ways(inputs)[1][:, None]

    def ways(self, inputs: ExploredInputs) -> tuple[Tensor, Tensor]:
        """Log V of each neighbour, with the step to it, against the best of them [K]; -log V of that [B]."""
        step = LEAST + softplus(self.step)
        costs = self.costs(inputs, step)[inputs.neighbours] + step * inputs.steps
        best = costs.new_full((len(inputs.told),), torch.inf)
        best = best.scatter_reduce(0, inputs.owners, costs, "amin")
        known = best.isfinite()
        gains = torch.where(known[inputs.owners], best[inputs.owners] - costs, 0.0)
        return gains.nan_to_num(neginf=WORST).clamp(min=WORST), torch.where(known, best, 0.0)

    def costs(self, inputs: ExploredInputs, step: Tensor) -> Tensor:
        """-log V of all nodes [P]; infinite where no node that was not visited can be reached."""
        prices = torch.where(inputs.is_end, softplus(self.rewards(inputs.frontier)), torch.inf)
        nodes, links, heads, following, lengths = (part.cpu().numpy() for part in inputs[:5])
        told = prices.detach().cpu().double().numpy()
        ends, distances = ends_of(nodes, links, heads, following, lengths, told, step.item())
        to = torch.from_numpy(ends).to(prices.device)
        far = torch.from_numpy(distances).to(prices.device, prices.dtype)
        return torch.where(to >= 0, prices[to.clamp(min=0)] + step * far, torch.inf)


class Perceptron(nn.Module):
    """A layer that looks at one node, and a number of it."""

    def __init__(self, shapes: Shapes, name: str) -> None:
        """Draw the weights."""
        super().__init__()
        self.inner, self.outer = (linear(shapes[f"{name}.{layer}.weight"]) for layer in ("inner", "outer"))

    def forward(self, traits: Tensor, words: Tensor | float = 0.0) -> Tensor:
        """From traits [n, any], and what is said to each node [n, HIDDEN], to numbers [n]."""
        number: Tensor = self.outer((self.inner(traits) + words).relu())[:, 0]
        return number
