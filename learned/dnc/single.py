"""One step of a DNC for one sample, without gradients, in one call.

For one sample, calls of PyTorch take longer than most of what they do. The rest of the time goes into reading weights.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import torch
from numba import carray  # type: ignore[attr-defined]  # it does
from torch import Tensor

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.controller_kernels import rows, squash_sample
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.dnc.job import SIZES, STATES, interface_size, sizes_of, state_of, tape_size, taped
from fogbench.learned.dnc.layout import Packed, layout
from fogbench.learned.dnc.step import step
from fogbench.learned.kernels.lanes import LANES, NUMBERS
from fogbench.learned.kernels.linear import apply
from fogbench.learned.kernels.native import job, matrix, run, vector
from fogbench.worlds.kernel import callback, kernel
from fogbench.worlds.types import Array

JOB = job(
    *SIZES, *STATES, "inputs", "hidden", "outputs", "clip",
    "x", "h", "c", "last_reads", "new_h", "new_c", "new_reads", "y",
    "gate_weight", "gate_bias", "interface_weight", "interface_bias", "output_weight", "output_bias",
)  # fmt: skip
"""What the memory access has of a step, then sizes, vectors and weights."""


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


def single_step(
    heads: Heads, weights: Weights, clip: int, vectors: Sequence[Tensor], access: AccessState[Tensor]
) -> tuple[Sequence[Tensor], Packed]:
    """One step of one sample.

    Args:
        heads: the sizes.
        weights: of all layers.
        clip: c and y stay within +-clip.
        vectors: x, h, c and what was read last, [1, any] or [any].
        access: the memory before.

    Returns:
        The next h and c, what is read, and y; and the memory after.
    """
    x, h, _, reads = vectors = [vector.contiguous() for vector in vectors]
    lies = layout(heads, access.usage.shape[-1], x.shape[:-1])
    old, new = lies.buffers(access), lies.empty(x)
    after = [torch.empty_like(vector) for vector in (h, h, reads)]
    after.append(x.new_empty(*x.shape[:-1], len(weights.output)))
    run(
        loop(NUMBERS[x.dtype]), 1, *lies.sizes, *old.addresses, *new.addresses,
        x.shape[-1], h.shape[-1], len(weights.output), clip,
        *(tensor.data_ptr() for tensor in (*vectors, *after, *weights)),
    )  # fmt: skip
    return after, lies.packed(lies.views(new), new)


@lru_cache
def loop(number: type[np.floating[Any]]) -> int:
    """The address of the step for a type of numbers."""

    def whole_step(address: Any) -> None:
        job = carray(address, 1, JOB)[0]
        sizes, inputs, h = sizes_of(job), job.inputs, job.hidden
        read, size = job.word * job.reads, interface_size(sizes)
        gates, tanhs, interface = np.empty(4 * h, number), np.empty(h, number), np.empty((1, size), number)
        told, known = np.empty(inputs + read + h, number), np.empty(h + read, number)
        told[:inputs] = vector(number, job.x, inputs)
        told[inputs : inputs + read] = vector(number, job.last_reads, read)
        told[inputs + read :] = vector(number, job.h, h)
        apply(matrix(number, job.gate_weight, 4 * h, len(told)), vector(number, job.gate_bias, 4 * h), told, gates)
        squash_sample(
            gates.reshape(-1, LANES), rows(number, job.c, h, 0), rows(number, job.new_h, h, 0),
            rows(number, job.new_c, h, 0), tanhs.reshape(-1, LANES),
        )  # fmt: skip
        known[:h] = vector(number, job.new_h, h)
        apply(
            matrix(number, job.interface_weight, size, h), vector(number, job.interface_bias, size), known[:h],
            interface[0],
        )  # fmt: skip
        reads = vector(number, job.new_reads, read)
        step(
            sizes, interface, state_of(number, job.old, job.old_links, job, 0),
            state_of(number, job.new, job.new_links, job, 0), reads.reshape(1, read),
            taped(sizes, np.empty((tape_size(sizes), LANES), number)),
        )  # fmt: skip
        known[h:] = reads
        y = vector(number, job.y, job.outputs)
        apply(matrix(number, job.output_weight, len(y), len(known)), vector(number, job.output_bias, len(y)), known, y)
        within(vector(number, job.new_c, h), job.clip)
        within(y, job.clip)

    return callback(whole_step)


@kernel
def within(x: Array, limit: int) -> None:
    """Clip to +-limit; NaN stays."""
    for n in range(len(x)):
        if abs(x[n]) > limit:
            x[n] = np.copysign(limit, x[n])
