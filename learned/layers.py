"""Layers of PyTorch, drawn as PyTorch draws them, of the shapes that their weights are to have."""

from torch import nn

from fogbench.learned.shapes import Shape


def linear(weight: Shape, *, bias: bool = True) -> nn.Linear:
    """A linear layer of a matrix [outputs, inputs]."""
    outputs, inputs = weight
    return nn.Linear(inputs, outputs, bias=bias)


def convolution(weight: Shape, *, bias: bool = True) -> nn.Conv2d:
    """A convolution of kernels [outputs, channels, side, side], where the side is odd; maps keep their size."""
    outputs, channels, side, _ = weight
    return nn.Conv2d(channels, outputs, side, padding=side // 2, bias=bias)
