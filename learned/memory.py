"""Policies that remember: features of what is seen go into a DNC, an LSTM, or a layer that forgets; scores come out."""

from typing import Any, Literal, NamedTuple, cast

import torch
from torch import Tensor, nn

from fogbench.learned.dnc.controller import Controller
from fogbench.learned.dnc.dnc import DNC
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.encoding.grid import COMPASS, SEEN, Inputs
from fogbench.learned.network import Network
from fogbench.learned.policy import Policy, Size
from fogbench.learned.value_iteration.sizes import ACTIONS


class Remembering(Policy):
    """A policy with a memory between what it sees and what it does."""

    memory: Literal["dnc", "lstm", "feedforward"] = "dnc"
    """A DNC, the LSTM of its controller alone, or, as an ablation, a layer that remembers nothing."""
    features: Size = 256
    """Numbers that the memory is told at a step."""
    hidden: Size = 256
    """The controller's size."""
    memory_rows: Size = 32
    """Rows of a DNC's memory; they may differ from the training's."""
    word: Size = 8
    """Numbers in a row."""
    reads: Size = 4
    """Read heads of a DNC."""
    writes: Size = 1
    """Write heads of a DNC."""
    links: bool = True
    """Whether a DNC keeps temporal links."""

    def idle(self) -> frozenset[str]:
        """Those of a DNC's memory, without one."""
        return frozenset() if self.memory == "dnc" else frozenset({"memory_rows", "word", "reads", "writes", "links"})

    def remember(self) -> "DNC | LSTM | FeedForward":
        """A memory with weights drawn anew."""
        if self.memory == "lstm":
            return LSTM(self.features, self.hidden)
        if self.memory == "feedforward":
            return FeedForward(self.features, self.hidden)
        heads = Heads(self.reads, self.writes, self.word, self.links)
        return DNC(self.features, ACTIONS, heads, rows=self.memory_rows, hidden=self.hidden)


class RememberingNetwork(Network):
    """What is planned, with the sight and the compass as low-level features, into a memory."""

    def __init__(self, settings: Remembering, planned: int) -> None:
        """Draw the weights; `planned` is how many numbers `plan` gives."""
        super().__init__()
        self.features = nn.Linear(planned + SEEN + COMPASS, settings.features)
        self.memory = settings.remember()

    def see(self, inputs: Inputs) -> Tensor:
        """The features [B, F] of what is seen; they depend on nothing that is remembered."""
        told = torch.cat([self.plan(inputs), inputs.sight.flatten(1), inputs.compass], 1)
        return cast(Tensor, self.features(told)).relu()

    def forward(self, inputs: Inputs, state: Any) -> tuple[Tensor, Any]:
        """One step."""
        return self.memory.step(self.see(inputs), state)

    def blank(self, batch: tuple[int, ...]) -> Any:
        """The memory's."""
        return self.memory.blank(batch)


class LSTMState(NamedTuple):
    """What an LSTM carries from one step to the next."""

    hidden: Tensor
    """[..., hidden]"""
    cell: Tensor
    """[..., hidden]"""


class LSTM(nn.Module):
    """The controller of a DNC without its memory."""

    def __init__(self, inputs: int, hidden: int) -> None:
        """Draw the weights."""
        super().__init__()
        self.controller = Controller(inputs, hidden)
        self.output = nn.Linear(hidden, ACTIONS)

    def blank(self, batch: tuple[int, ...] = ()) -> LSTMState:
        """The state before the first step: zeros."""
        zeros = self.output.weight.new_zeros(*batch, self.controller.hidden)
        return LSTMState(zeros, zeros)

    def step(self, x: Tensor, state: LSTMState) -> tuple[Tensor, LSTMState]:
        """From features [..., inputs] to scores [..., 4] and the next state."""
        hidden, cell = self.controller(x, state)
        return self.output(hidden), LSTMState(hidden, cell)


class FeedForward(nn.Module):
    """A layer in the place of the controller."""

    def __init__(self, inputs: int, hidden: int) -> None:
        """Draw the weights."""
        super().__init__()
        self.controller = nn.Linear(inputs, hidden)
        self.output = nn.Linear(hidden, ACTIONS)

    def blank(self, batch: tuple[int, ...] = ()) -> tuple[()]:
        """Nothing is remembered, whatever the batch."""
        del batch
        return ()

    def step(self, x: Tensor, state: tuple[()]) -> tuple[Tensor, tuple[()]]:
        """From features [..., inputs] to scores [..., 4]."""
        return self.output(self.controller(x).relu()), state
