"""Linear layers of one sample in compiled loops."""

from typing import Any

from fogbench.worlds.kernel import kernel, summing
from fogbench.worlds.types import Array


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
