"""Convolutions of one sample in compiled loops: the channels are lanes, so they are filled up to sixteens.

Words used here
    plane   [P, C] a map of H x W cells, row after row, with a zero cell after each row, W + 2 before the first cell and
            W + 1 after the last: cell (y, x) is number (y + 1) * (W + 1) + x + 1, and a neighbour is only a shift
    row     W + 1
"""

from fogbench.learned.kernels.functions import larger
from fogbench.learned.kernels.instructions import at, put
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array

TOGETHER = 4
"""Cells that share each weight, in registers; they divide H * (W + 1)."""


@fused
def convolve(x: Array, kernels: Array, bias: Array, row: int, y: Array) -> None:
    """A convolution of 3x3 cells, without what is negative.

    Args:
        x: a plane of channels; the convolution sees the first of them, as many as it has kernels for.
        kernels: [outputs / 16 * 9 * inputs, 16], the outputs in lanes.
        bias: [outputs / 16, 16].
        row: of the planes.
        y: the plane [P, outputs] to fill; the zeros around the map must be there.
    """
    inputs = len(kernels) // (9 * len(bias))
    for block in range(len(bias)):
        out = y[:, block * LANES :]
        for cell in range(row + 1, len(x) - row - 1, TOGETHER):
            a = at(bias, block)
            b, c, d = a, a, a
            weight = block * 9 * inputs
            for tap in range(9):
                seen = cell + (tap // 3 - 1) * row + tap % 3 - 1
                for channel in range(inputs):
                    w = at(kernels, weight)
                    weight += 1
                    a += w * x[seen, channel]
                    b += w * x[seen + 1, channel]
                    c += w * x[seen + 2, channel]
                    d += w * x[seen + 3, channel]
            put(out, cell, larger(0, a))
            put(out, cell + 1, larger(0, b))
            put(out, cell + 2, larger(0, c))
            put(out, cell + 3, larger(0, d))
    y[2 * row : len(y) - row : row] = 0
