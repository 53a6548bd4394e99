"""The loops of a 3x3 convolution of sixteen samples that lie side by side, forward and back.

Words used here
    plane     [P, 16] as in `fogbench.learned.kernels.planes`, with a row for each cell: cell (y, x) of the maps is
              number (y + 1) * row + x + 1, and a neighbour is only a shift
    row       W + 1;  P = (H + 2) * row + 2, the `size` of a plane
    x, y      [channels * P, 16] the planes before and after a convolution; d is the gradient by y
    weights   [outputs * inputs * 9] as PyTorch has them
    steps     how far apart in them are two outputs, two inputs and two neighbours, and where the first of these is; for
              the way back they change places
"""

from typing import Any

from fogbench.learned.kernels.functions import larger
from fogbench.learned.kernels.instructions import at, full, put, until
from fogbench.learned.kernels.lane_arrays import add
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.planes import clear
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array

FOUR = 4
"""Outputs that are made together, two cells of each."""


@fused
def convolve(x: Array, inputs: int, weights: Array, biases: Array, size: int, row: int, y: Array) -> None:
    """Make `y` the sums over neighbours in `x`, without what is negative."""
    for first in range(0, len(biases), FOUR):
        planes, own = y[first * size :], weights[first * inputs * 9 :]
        a, b = full(x, biases[first]), full(x, biases[first + 1])
        c, d = full(x, biases[first + 2]), full(x, biases[first + 3])
        for cell in range(row + 1, size - row - 1, 2):
            one, other = sums(x, inputs, own, (inputs * 9, 9, 1, 0), size, row, cell, a, b, c, d)
            for k in range(2):
                here = one if k == 0 else other
                put(planes, cell + k, larger(0, here[0]))
                put(planes, size + cell + k, larger(0, here[1]))
                put(planes, 2 * size + cell + k, larger(0, here[2]))
                put(planes, 3 * size + cell + k, larger(0, here[3]))
    clear_rims(y, size, row)


@fused
def convolve_back(d: Array, outputs: int, weights: Array, x: Array, size: int, row: int, d_x: Array) -> None:
    """Make `d_x` the gradient by what `x` was before its negative numbers were left out.

    That is a convolution of `d`, with inputs for outputs and each neighbour for the one across.
    """
    zero, inputs = full(d, 0), len(x) // size
    for first in range(0, inputs, FOUR):
        own, here, planes = weights[first * 9 :], x[first * size :], d_x[first * size :]
        for cell in range(row + 1, size - row - 1, 2):
            one, other = sums(d, outputs, own, (9, inputs * 9, -1, 8), size, row, cell, zero, zero, zero, zero)
            for k in range(2):
                some = one if k == 0 else other
                put(planes, cell + k, until(at(here, cell + k), 0, 0, some[0]))
                put(planes, size + cell + k, until(at(here, size + cell + k), 0, 0, some[1]))
                put(planes, 2 * size + cell + k, until(at(here, 2 * size + cell + k), 0, 0, some[2]))
                put(planes, 3 * size + cell + k, until(at(here, 3 * size + cell + k), 0, 0, some[3]))
    clear_rims(d_x, size, row)


@fused
def sums(
    x: Array, inputs: int, weights: Array, steps: tuple[int, int, int, int], size: int, row: int, cell: int,
    a: Any, b: Any, c: Any, d: Any,
) -> tuple[Any, Any]:  # fmt: skip
    """What four outputs add up to at a cell and at the next, from a, b, c and d on."""
    (out, step, tap, start), e, f, g, h = steps, a, b, c, d
    for channel in range(inputs):
        k = channel * step + start
        for down in range(3):
            first = channel * size + cell + (down - 1) * row - 1
            for right in range(3):
                here, next_ = at(x, first + right), at(x, first + right + 1)
                a, b = a + weights[k] * here, b + weights[k + out] * here
                c, d = c + weights[k + 2 * out] * here, d + weights[k + 3 * out] * here
                e, f = e + weights[k] * next_, f + weights[k + out] * next_
                g, h = g + weights[k + 2 * out] * next_, h + weights[k + 3 * out] * next_
                k += tap
    return (a, b, c, d), (e, f, g, h)


@fused
def clear_rims(y: Array, size: int, row: int) -> None:
    """Set to zero all that is no cell of a map."""
    for first in range(0, len(y), size):
        clear(y[first : first + size].reshape(-1), LANES, (size - 2) // row - 2, row - 1)


@fused
def weigh(x: Array, inputs: int, d: Array, size: int, row: int, d_weights: Array) -> None:
    """Add to `d_weights` the gradients by the weights, of which each lane has a share."""
    for first in range(0, len(d) // size, FOUR):
        planes, own = d[first * size :], d_weights[first * inputs * 9 :]
        for channel in range(inputs):
            for down in range(3):
                before, k = channel * size + (down - 1) * row - 1, channel * 9 + down * 3
                weigh_row(x, before, planes, size, row, own[k:], inputs * 9)


@fused
def weigh_row(x: Array, before: int, d: Array, size: int, row: int, d_weights: Array, out: int) -> None:
    """The same of three neighbours in a row, for four outputs, which share what they load."""
    zero = full(x, 0)
    a0, a1, a2, a3 = zero, zero, zero, zero
    b0, b1, b2, b3 = zero, zero, zero, zero
    c0, c1, c2, c3 = zero, zero, zero, zero
    for cell in range(row + 1, size - row - 1):
        left, own, right = at(x, before + cell), at(x, before + cell + 1), at(x, before + cell + 2)
        d0, d1, d2, d3 = at(d, cell), at(d, size + cell), at(d, 2 * size + cell), at(d, 3 * size + cell)
        a0, a1, a2, a3 = a0 + left * d0, a1 + left * d1, a2 + left * d2, a3 + left * d3
        b0, b1, b2, b3 = b0 + own * d0, b1 + own * d1, b2 + own * d2, b3 + own * d3
        c0, c1, c2, c3 = c0 + right * d0, c1 + right * d1, c2 + right * d2, c3 + right * d3
    add_three(d_weights, a0, b0, c0)
    add_three(d_weights[out:], a1, b1, c1)
    add_three(d_weights[2 * out :], a2, b2, c2)
    add_three(d_weights[3 * out :], a3, b3, c3)


@fused
def add_three(rows: Array, a: Any, b: Any, c: Any) -> None:
    """Add to three rows."""
    add(rows, 0, a)
    add(rows, 1, b)
    add(rows, 2, c)


@fused
def bias_back(d: Array, size: int, d_biases: Array) -> None:
    """Add to `d_biases` the gradients by the biases, of which each lane has a share."""
    for channel in range(len(d) // size):
        sum_ = full(d, 0)
        for cell in range(size):
            sum_ += at(d, channel * size + cell)
        add(d_biases, channel, sum_)
