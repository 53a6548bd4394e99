"""The loops of the controller over the gates of a sample, forward and backward, sixteen at a time."""

from typing import Any

from numba import carray  # type: ignore[attr-defined]  # it does

from fogbench.learned.kernels.functions import sigmoid, tanh
from fogbench.learned.kernels.instructions import at, put
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.native import Loop, job, pointer
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array


@kernel
def squash(number: Any, job: Any, sample: int) -> None:
    """Squash the gates of a sample where they lie, and find h, c and the tanh of c."""
    h = job.hidden
    squash_sample(
        rows(number, job.gates, 4 * h, sample), rows(number, job.cell, h, sample),
        rows(number, job.h, h, sample), rows(number, job.c, h, sample), rows(number, job.tanh, h, sample),
    )  # fmt: skip


@kernel
def squash_back(number: Any, job: Any, sample: int) -> None:
    """Find the gradients by a sample's gates not yet squashed and by its cell."""
    h = job.hidden
    squash_sample_back(
        rows(number, job.gates, 4 * h, sample), rows(number, job.cell, h, sample),
        rows(number, job.d_h, h, sample), rows(number, job.d_c, h, sample), rows(number, job.tanh, h, sample),
        rows(number, job.d_gates, 4 * h, sample), rows(number, job.d_cell, h, sample),
    )  # fmt: skip


@kernel
def rows(number: Any, address: int, size: int, sample: int) -> Array:
    """[size / 16, 16] one sample's numbers of an array [B, size]."""
    count = size // LANES
    return carray(pointer(address), ((sample + 1) * count, LANES), number)[sample * count :]


@fused
def squash_sample(gates: Array, cell: Array, h: Array, c: Array, tanhs: Array) -> None:
    """One sample."""
    count = len(cell)
    for k in range(count):
        write, forget = sigmoid(at(gates, k)), sigmoid(at(gates, count + k))
        candidate, output = tanh(at(gates, 2 * count + k)), sigmoid(at(gates, 3 * count + k))
        new = forget * at(cell, k) + write * candidate
        put(c, k, new)
        put(tanhs, k, tanh(new))
        put(h, k, output * tanh(new))
        put(gates, k, write)
        put(gates, count + k, forget)
        put(gates, 2 * count + k, candidate)
        put(gates, 3 * count + k, output)


@fused
def squash_sample_back(
    gates: Array, cell: Array, d_h: Array, d_c: Array, tanhs: Array, d_gates: Array, d_cell: Array
) -> None:
    """Back through one sample."""
    count = len(cell)
    for k in range(count):
        write, forget = at(gates, k), at(gates, count + k)
        candidate, output = at(gates, 2 * count + k), at(gates, 3 * count + k)
        g, t = at(d_h, k), at(tanhs, k)
        d_new = at(d_c, k) + g * output * (1 - t * t)
        put(d_gates, k, d_new * candidate * write * (1 - write))
        put(d_gates, count + k, d_new * at(cell, k) * forget * (1 - forget))
        put(d_gates, 2 * count + k, d_new * write * (1 - candidate * candidate))
        put(d_gates, 3 * count + k, g * t * output * (1 - output))
        put(d_cell, k, d_new * forget)


FORWARD = Loop(squash, job("hidden", "gates", "cell", "h", "c", "tanh"))
BACKWARD = Loop(squash_back, job("hidden", "gates", "cell", "d_h", "d_c", "tanh", "d_gates", "d_cell"))
"""The size H, then addresses: gates [B, 4 * H], all others [B, H]; `cell` is that before the step. A block is a sample.
"""
