"""Layers by the shapes of their weights."""

from torch import nn

from fogbench.learned.shapes import Shapes


def linear(shapes: Shapes, name: str) -> nn.Linear:
    """The linear map of a name among `shapes`, with weights drawn anew."""
    outputs, inputs = shapes[f"{name}.weight"]
    return nn.Linear(inputs, outputs, bias=f"{name}.bias" in shapes)


def convolution(shapes: Shapes, name: str) -> nn.Conv2d:
    """The convolution of a name among `shapes`, with weights drawn anew; its maps have the size of the image."""
    outputs, inputs, side, _ = shapes[f"{name}.weight"]
    return nn.Conv2d(inputs, outputs, side, padding=side // 2)
