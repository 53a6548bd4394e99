"""Settings of policies that remember: features of what is seen go into a DNC, an LSTM, a GRU, or a layer that forgets.

Importing this imports no torch.
"""

from typing import Annotated, Literal

from pydantic import Field

from fogbench.learned.dnc.heads import Heads, controller_shapes
from fogbench.learned.dnc.heads import shapes as dnc_shapes
from fogbench.learned.policy import Size
from fogbench.learned.shapes import Shapes, linear, parts
from fogbench.learned.showing import Showing

HeadCount = Annotated[int, Field(ge=1, le=64)]
"""Of one sort; each write head has links from every row to every other."""


Links = Annotated[int, Field(ge=1, le=1024)]
"""Of a row."""


class Remembering(Showing):
    """A policy with a memory between what it sees and what it does."""

    memory: Literal["dnc", "lstm", "gru", "feedforward"] = "dnc"
    """A DNC, the LSTM of its controller alone, a GRU, or, as an ablation, a layer that remembers nothing."""
    features: Size | None = 256
    """Numbers that the memory is told at a step; null: all that is seen and planned, as it is."""
    hidden: Size = 256
    """The controller's size."""
    memory_rows: Size = 32
    """Rows of a DNC's memory; they may differ from the training's."""
    word: Size = 8
    """Numbers in a row."""
    reads: HeadCount = 4
    """Read heads of a DNC."""
    writes: HeadCount = 1
    """Write heads of a DNC."""
    links: bool | Links = True
    """Whether a DNC keeps temporal links; a number: of each row so many, the strongest (Rae et al. 2016)."""

    @property
    def heads(self) -> Heads:
        """The sizes of a DNC's memory but for its rows."""
        kept = 0 if isinstance(self.links, bool) else self.links
        return Heads(self.reads, self.writes, self.word, bool(self.links), kept)

    def idle(self) -> frozenset[str]:
        """Those of a DNC's memory, without one."""
        return frozenset() if self.memory == "dnc" else frozenset({"memory_rows", "word", "reads", "writes", "links"})

    def remembering_shapes(self, planned: int) -> Shapes:
        """The shapes of the features' weights, and of the memory's; `planned` numbers come from a planning module."""
        told = planned + self.seen_count
        if self.features is None:
            return parts(memory=self.memory_shapes(told))
        return parts(features=linear(told, self.features), memory=self.memory_shapes(self.features))

    def memory_shapes(self, inputs: int) -> Shapes:
        """The shapes of the memory's weights, which is told so many numbers."""
        if self.memory == "lstm":
            return lstm_shapes(inputs, self.output_count, self.hidden)
        if self.memory == "gru":
            return gru_shapes(inputs, self.output_count, self.hidden)
        if self.memory == "feedforward":
            return feedforward_shapes(inputs, self.output_count, self.hidden)
        return dnc_shapes(inputs, self.output_count, self.heads, self.hidden)


def lstm_shapes(inputs: int, outputs: int, hidden: int) -> Shapes:
    """Those of the controller of a DNC without its memory."""
    return parts(controller=controller_shapes(inputs, hidden), output=linear(hidden, outputs))


def gru_shapes(inputs: int, outputs: int, hidden: int) -> Shapes:
    """Those of a GRU in the place of the controller, by the names that PyTorch has for them."""
    weights: Shapes = {"weight_ih": (3 * hidden, inputs), "weight_hh": (3 * hidden, hidden)}
    biases: Shapes = {"bias_ih": (3 * hidden,), "bias_hh": (3 * hidden,)}
    return parts(controller={**weights, **biases}, output=linear(hidden, outputs))


def feedforward_shapes(inputs: int, outputs: int, hidden: int) -> Shapes:
    """Those of a layer in the place of the controller."""
    return parts(controller=linear(inputs, hidden), output=linear(hidden, outputs))
