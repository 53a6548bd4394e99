"""Functions of lanes: the exponential and its kin, which have no instruction."""

import math
from typing import Any

from fogbench.learned.kernels.instructions import halved, until, whole
from fogbench.worlds.kernel import fused

LN2 = math.log(2)
SERIES = tuple(1 / math.factorial(k) for k in range(13, -1, -1))


@fused
def larger(x: Any, y: Any) -> Any:
    """The larger of two; NaN in y counts as larger, NaN in x as smaller."""
    return until(y, x, x, y)


@fused
def decay(x: Any) -> Any:
    """e^-|x|, and e^-87 where that is less.

    e^-|x| = 2^-h * e^r, where h is whole and |r| < 0.35, so that 13 terms of the series of e^r are exact in float64.
    """
    x = until(x, 0, x, 0 - x)
    x = until(x, -87, -87, x)
    halvings = whole(x * (-1 / LN2) + 0.5)
    r = x + halvings * LN2
    power = SERIES[0] + 0 * r
    for factor in SERIES[1:]:
        power = power * r + factor
    return power * halved(halvings)


@fused
def logarithm(x: Any) -> Any:
    """log(1 + x) of x in [0, 1], by 17 terms of the series 2 * (s + s^3 / 3 + ...), s = x / (2 + x)."""
    s = x / (2 + x)
    square = s * s
    total = 1 / 33 + 0 * s
    for term in (1 / 31, 1 / 29, 1 / 27, 1 / 25, 1 / 23, 1 / 21, 1 / 19, 1 / 17, 1 / 15, 1 / 13, 1 / 11, 1 / 9, 1 / 7):
        total = total * square + term
    return 2 * s * (((total * square + 1 / 5) * square + 1 / 3) * square + 1)


@fused
def sigmoid(x: Any) -> Any:
    """1 / (1 + e^-x)."""
    e = decay(x)
    return until(x, 0, e, 1) / (1 + e)


@fused
def tanh(x: Any) -> Any:
    """(e^x - e^-x) / (e^x + e^-x)."""
    e = decay(2 * x)
    size = (1 - e) / (1 + e)
    return until(x, 0, 0 - size, size)


@fused
def softplus(x: Any) -> Any:
    """log(1 + e^x)."""
    return larger(0, x) + logarithm(decay(x))
