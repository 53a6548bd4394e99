"""The sizes of the four convolutions' weights, which need no PyTorch."""

from itertools import pairwise

from fogbench.learned.shapes import Shapes, convolution, parts

SIDE = 3
"""Of the kernels."""


def shapes(inputs: int, channels: int, outputs: int) -> Shapes:
    """Four in a row, each before a layer without weights; all but the last have as many `channels`."""
    widths = inputs, channels, channels, channels, outputs
    return parts(**{str(2 * k): convolution(*ends, SIDE) for k, ends in enumerate(pairwise(widths))})
