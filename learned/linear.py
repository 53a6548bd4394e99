"""Linear layers of one sample in compiled loops, and the arrays at the addresses of a job."""

from typing import Any

from numba import carray  # type: ignore[attr-defined]  # it does

from learned.native import pointer
from worlds.kernel import kernel, summing
from worlds.types import Array


@kernel
def vector(number: Any, address: int, size: int) -> Array:
    """[size] there."""
    return carray(pointer(address), (size,), number)


@kernel
def matrix(number: Any, address: int, height: int, width: int) -> Array:
    """[height, width] there."""
    return carray(pointer(address), (height, width), number)


@kernel
def apply(weight: Array, bias: Array, x: Array, y: Array) -> None:
    """Make y the weight times x, and the bias: row after row, as the matrix lies in memory."""
    for n in range(len(y)):
        y[n] = bias[n] + product(weight[n], x)


@summing
def product(x: Array, y: Array) -> Any:
    """The scalar product."""
    total = x.dtype.type(0)
    for k in range(len(x)):
        total += x[k] * y[k]
    return total
