"""Networks that remember: features of what is seen go into a DNC, an LSTM, a GRU, or a layer that forgets."""

from typing import Any, NamedTuple, cast

import torch
from torch import Tensor, nn

from fogbench.learned.dnc.controller import Controller
from fogbench.learned.dnc.dnc import DNC
from fogbench.learned.layers import linear
from fogbench.learned.memory import Remembering, feedforward_shapes, gru_shapes, lstm_shapes
from fogbench.learned.networks.network import Network


class RememberingNetwork(Network):
    """A memory, and the layer before it, if there is one."""

    def __init__(self, settings: Remembering, planned: int) -> None:
        """Draw the weights; the memory is told so many numbers beside what is seen."""
        super().__init__()
        shape = settings.remembering_shapes(planned).get("features.weight")
        self.features = linear(shape) if shape else None
        self.memory = remember(settings, shape[0] if shape else planned + settings.seen_count)

    def told(self, seen: Tensor) -> Tensor:
        """The features of what is seen and planned, or that itself."""
        return seen if self.features is None else cast(Tensor, self.features(seen)).relu()

    def blank(self, batch: tuple[int, ...]) -> Any:
        """The memory's."""
        return self.memory.blank(batch)


class ImageNetwork(RememberingNetwork):
    """What is made of an image, with what is seen beside it, into a memory, which scores the outputs."""

    def see(self, inputs: Any) -> Tensor:
        """What the memory is told [B, any]; it depends on nothing that is remembered."""
        return self.told(torch.cat([*self.made(inputs), *inputs.beside], 1))

    def made(self, inputs: Any) -> tuple[Tensor, ...]:
        """What the network makes of what is seen, `planned` numbers [B, any] in all."""
        return (self.plan(inputs),)

    def forward(self, inputs: Any, state: Any) -> tuple[Tensor, Any]:
        """One step."""
        return self.memory.step(self.see(inputs), state)


def remember(settings: Remembering, inputs: int) -> "DNC | LSTM | GRU | FeedForward":
    """The memory of some settings that is told so many numbers, with weights drawn anew."""
    outputs, hidden = settings.output_count, settings.hidden
    if settings.memory == "lstm":
        return LSTM(inputs, outputs, hidden)
    if settings.memory == "gru":
        return GRU(inputs, outputs, hidden)
    if settings.memory == "feedforward":
        return FeedForward(inputs, outputs, hidden)
    return DNC(inputs, outputs, settings.heads, rows=settings.memory_rows, hidden=hidden)


class LSTMState(NamedTuple):
    """What an LSTM carries from one step to the next."""

    hidden: Tensor
    """[..., hidden]"""
    cell: Tensor
    """[..., hidden]"""


class LSTM(nn.Module):
    """The controller of a DNC without its memory."""

    def __init__(self, inputs: int, outputs: int, hidden: int) -> None:
        """Draw the weights."""
        super().__init__()
        self.controller = Controller(inputs, hidden)
        self.output = linear(lstm_shapes(inputs, outputs, hidden)["output.weight"])

    def blank(self, batch: tuple[int, ...] = ()) -> LSTMState:
        """The state before the first step: zeros."""
        zeros = self.output.weight.new_zeros(*batch, self.controller.hidden)
        return LSTMState(zeros, zeros)

    def step(self, x: Tensor, state: LSTMState) -> tuple[Tensor, LSTMState]:
        """From features [..., inputs] to scores [..., outputs] and the next state."""
        hidden, cell = self.controller(x, state)
        return self.output(hidden), LSTMState(hidden, cell)


class GRUState(NamedTuple):
    """What a GRU carries from one step to the next."""

    hidden: Tensor
    """[..., hidden]"""


class GRU(nn.Module):
    """A gated recurrent unit (Cho et al. 2014), PyTorch's, in the place of the controller."""

    def __init__(self, inputs: int, outputs: int, hidden: int) -> None:
        """Draw the weights."""
        super().__init__()
        self.controller = nn.GRUCell(inputs, hidden)
        self.output = linear(gru_shapes(inputs, outputs, hidden)["output.weight"])

    def blank(self, batch: tuple[int, ...] = ()) -> GRUState:
        """The state before the first step: zeros."""
        return GRUState(self.output.weight.new_zeros(*batch, self.controller.hidden_size))

    def step(self, x: Tensor, state: GRUState) -> tuple[Tensor, GRUState]:
        """From features [..., inputs] to scores [..., outputs] and the next state."""
        hidden = self.controller(x, state.hidden)
        return self.output(hidden), GRUState(hidden)


class FeedForward(nn.Module):
    """A layer in the place of the controller."""

    def __init__(self, inputs: int, outputs: int, hidden: int) -> None:
        """Draw the weights."""
        super().__init__()
        shapes = feedforward_shapes(inputs, outputs, hidden)
        self.controller, self.output = linear(shapes["controller.weight"]), linear(shapes["output.weight"])

    def blank(self, batch: tuple[int, ...] = ()) -> tuple[()]:
        """Nothing is remembered, whatever the batch."""
        del batch
        return ()

    def step(self, x: Tensor, state: tuple[()]) -> tuple[Tensor, tuple[()]]:
        """From features [..., inputs] to scores [..., outputs]."""
        return self.output(self.controller(x).relu()), state
