"""One step of a DNC for one sample, without gradients, in one call.

For one sample, calls of PyTorch take longer than most of what they do. The rest of the time goes into reading weights.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # it does
from torch import Tensor

from learned.dnc_access import AccessState, Heads
from learned.dnc_controller_kernels import rows, squash_sample
from learned.dnc_kernels import STEP, interface_size, samples_of, sizes_of, state_of, step, tape_of
from learned.dnc_layout import Packed, layout
from learned.lanes import LANES, NUMBERS
from learned.native import job, pointer, run
from worlds.kernel import callback, kernel, summing
from worlds.types import Array

JOB = job(
    *STEP, "inputs", "hidden", "outputs", "x", "reads_before", "h", "c", "new_h", "new_c", "y",
    "gate_weight", "gate_bias", "interface_weight", "interface_bias", "output_weight", "output_bias",
)  # fmt: skip
"""What a step of the memory access needs, then sizes, vectors and weights; `interface` is room for one."""


class Weights(NamedTuple):
    """Of all layers, as the job has them."""

    gates: Tensor
    """[4 * H, inputs + R * D + H], for x, what was read last, and h."""
    gate_bias: Tensor
    interface: Tensor
    """[I, H]"""
    interface_bias: Tensor
    output: Tensor
    """[outputs, H + R * D], for h and what is read."""
    output_bias: Tensor


class Stepped(NamedTuple):
    """What a step gives; nothing is clipped."""

    y: Tensor
    h: Tensor
    c: Tensor
    reads: Tensor
    """[..., R * D]"""
    access: Packed


def single_step(
    heads: Heads, weights: Weights, x: Tensor, reads: Tensor, h: Tensor, c: Tensor, access: AccessState[Tensor]
) -> Stepped:
    """One step from x, what was read last, h, c and the memory: [1, any] or [any]."""
    batch = x.shape[:-1]
    lies = layout(heads, access.usage.shape[-1], batch)
    old, new, tape = lies.buffers(access), lies.empty(x), x.new_empty(lies.tape)
    vectors = x, reads, h, c = [vector.contiguous() for vector in (x, reads, h, c)]
    weights = Weights(*(weight.contiguous() for weight in weights))
    interface, y = x.new_empty(heads.interface), x.new_empty(*batch, len(weights.output))
    read, new_h, new_c = (vector.new_empty(vector.shape) for vector in (reads, h, c))
    run(
        loop(NUMBERS[x.dtype]), 1, *lies.sizes,
        interface.data_ptr(), *old.addresses, *new.addresses, read.data_ptr(), tape.data_ptr(),
        x.shape[-1], h.shape[-1], y.shape[-1],
        *(tensor.data_ptr() for tensor in (*vectors, new_h, new_c, y, *weights)),
    )  # fmt: skip
    return Stepped(y, new_h, new_c, read, lies.packed(lies.views(new), new))


@lru_cache
def loop(number: type[np.floating[Any]]) -> int:
    """The address of the step for a type of numbers."""

    def whole_step(address: Any) -> None:
        job = carray(address, 1, JOB)[0]
        read, h, size = job.reads * job.word, job.hidden, interface_size(sizes_of(job))
        gates, tanhs = np.empty(4 * h, number), np.empty(h, number)
        told, known = np.empty(job.inputs + read + h, number), np.empty(h + read, number)
        told[: job.inputs] = vector(number, job.x, job.inputs)
        told[job.inputs : job.inputs + read] = vector(number, job.reads_before, read)
        told[job.inputs + read :] = vector(number, job.h, h)
        apply(matrix(number, job.gate_weight, 4 * h, len(told)), vector(number, job.gate_bias, 4 * h), told, gates)
        squash_sample(
            gates.reshape(-1, LANES), rows(number, job.c, h, 0), rows(number, job.new_h, h, 0),
            rows(number, job.new_c, h, 0), tanhs.reshape(-1, LANES),
        )  # fmt: skip
        known[:h] = vector(number, job.new_h, h)
        apply(
            matrix(number, job.interface_weight, size, h), vector(number, job.interface_bias, size), known[:h],
            vector(number, job.interface, size),
        )  # fmt: skip
        step(
            sizes_of(job), samples_of(number, job.interface, size, job, 0),
            state_of(number, job.old, job.old_links, job, 0), state_of(number, job.new, job.new_links, job, 0),
            samples_of(number, job.read, read, job, 0), tape_of(number, job, 0),
        )  # fmt: skip
        known[h:] = vector(number, job.read, read)
        apply(
            matrix(number, job.output_weight, job.outputs, len(known)), vector(number, job.output_bias, job.outputs),
            known, vector(number, job.y, job.outputs),
        )  # fmt: skip

    return callback(whole_step)


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
