"""The differentiable neural computer: an LSTM that reads and writes a memory (Graves et al. 2016).

Clipped, and started from zeros, as in google-deepmind/dnc.
"""

from typing import NamedTuple

import torch
from torch import Tensor, nn

from fogbench.learned.dnc.access import AccessState, access, blank, controls
from fogbench.learned.dnc.controller import Controller
from fogbench.learned.dnc.fast import fast_access
from fogbench.learned.dnc.heads import Heads, shapes
from fogbench.learned.dnc.single import Weights, single_step
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.layers import linear


class DNCState(NamedTuple):
    """What a DNC carries from one step to the next."""

    hidden: Tensor
    """[..., hidden], the controller's output."""
    cell: Tensor
    """[..., hidden]"""
    reads: Tensor
    """[..., R * D]"""
    access: AccessState[Tensor]
    """The memory and how it was used."""


class DNC(nn.Module):
    """Controller, interface, memory access and output. No parameter depends on the number of rows."""

    def __init__(
        self,
        inputs: int,
        outputs: int,
        heads: Heads,
        *,
        rows: int = 32,
        hidden: int = 256,
        clip: int = 20,
        fast: bool = True,
        keep_links_every: int = 1,
    ) -> None:
        """Draw the weights.

        Args:
            inputs: numbers in.
            outputs: numbers out.
            heads: the sizes of the memory access but for its rows.
            rows: memory rows of a blank state; may be changed at any time.
            hidden: the controller's size.
            clip: the controller's cell and the outputs stay within +-clip.
            fast: use the fused loops where the tensors are on the CPU.
            keep_links_every: see `fast_access`.
        """
        super().__init__()
        self.heads, self.rows, self.clip, self.fast, self.keep_links_every = heads, rows, clip, fast, keep_links_every
        sizes = shapes(inputs, outputs, heads, hidden)
        self.controller = Controller(inputs + heads.read, hidden)
        self.interface = linear(sizes["interface.weight"])
        self.output = linear(sizes["output.weight"])
        self.settled: Weights | None = None

    def settle(self) -> None:
        """Get ready for single steps without gradients: from now on the weights must not change."""
        layers = self.controller, self.interface, self.output
        weights = [tensor.detach() for layer in layers for tensor in (layer.weight, layer.bias)]
        if self.fast and weights[0].is_cpu and self.controller.hidden % LANES == 0:
            self.settled = Weights(*weights)

    def blank(self, batch: tuple[int, ...] = ()) -> DNCState:
        """The state before the first step: zeros."""
        weight = self.output.weight
        hidden = weight.new_zeros(*batch, self.controller.hidden)
        reads = weight.new_zeros(*batch, self.heads.read)
        return DNCState(hidden, hidden, reads, blank(self.heads, self.rows, batch, weight))

    def step(self, x: Tensor, state: DNCState) -> tuple[Tensor, DNCState]:
        """From inputs [..., inputs], with or without a batch, to outputs [..., outputs] and the next state."""
        if self.settled and x.numel() == x.shape[-1]:
            vectors = x, state.hidden, state.cell, state.reads
            (hidden, cell, reads, y), packed = single_step(self.heads, self.settled, self.clip, vectors, state.access)
            return y, DNCState(hidden, cell, reads, packed)
        before = state.hidden, state.cell
        hidden, cell = self.controller(torch.cat([x, state.reads], -1), before, fast=self.fast)
        cell = cell.clamp(-self.clip, self.clip)  # `hidden` is within +-1 by itself
        reads, after = self.access(self.interface(hidden), state.access)
        reads = reads.flatten(-2)  # [..., R, D] -> [..., R * D]
        y = self.output(torch.cat([hidden, reads], -1)).clamp(-self.clip, self.clip)
        return y, DNCState(hidden, cell, reads, after)

    def access(self, interface: Tensor, state: AccessState[Tensor]) -> tuple[Tensor, AccessState[Tensor]]:
        """The memory access for an interface vector [..., I]."""
        if self.fast and interface.is_cpu:
            return fast_access(self.heads, interface, state, self.keep_links_every)
        return access(controls(self.heads, interface), state, self.heads.strongest(state.usage.shape[-1]))

    def forward(self, sequence: Tensor, state: DNCState | None = None) -> tuple[Tensor, DNCState]:
        """Steps through `sequence` [B, T, inputs] or [T, inputs], from a blank state if none is given.

        Returns:
            The outputs [B, T, outputs] or [T, outputs], and the state after the last step.
        """
        state = self.blank(sequence.shape[:-2]) if state is None else state
        outputs = []
        for x in sequence.unbind(-2):
            y, state = self.step(x, state)
            outputs.append(y)
        return torch.stack(outputs, -2), state
