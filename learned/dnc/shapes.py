"""The shapes of a DNC's weights, and of its controller's. Importing this imports no torch."""

from fogbench.learned.dnc.heads import Heads
from fogbench.learned.shapes import Shapes, joined, linear


def controller_shapes(inputs: int, hidden: int) -> Shapes:
    """Those of one step of an LSTM: four gates, each of `inputs` numbers and of the last output."""
    return {"weight": (4 * hidden, inputs + hidden), "bias": (4 * hidden,)}


def dnc_shapes(inputs: int, outputs: int, heads: Heads, hidden: int) -> Shapes:
    """Those of a DNC; none depends on the number of rows."""
    read = heads.reads * heads.word
    return joined(
        controller=controller_shapes(inputs + read, hidden),
        interface=linear(hidden, heads.interface),
        output=linear(hidden + read, outputs),
    )
