"""One step of a DNC for one sample, without gradients, in one call.

For one sample, calls of PyTorch take longer than most of what they do. The rest of the time goes into reading weights.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.controller_kernels import rows, squash_sample
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.dnc.job import SIZES, STATES, sizes_of, state_of, taped
from fogbench.learned.dnc.layout import Packed, arranged
from fogbench.learned.dnc.step import step
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.linear import apply
from fogbench.learned.kernels.native import Loop, job, matrix, vector
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

JOB = job(
    *SIZES, "inputs", "hidden", "outputs", "clip", *STATES,
    "x", "h", "c", "last_reads", "new_h", "new_c", "new_reads", "y",
    "gate_weight", "gate_bias", "interface_weight", "interface_bias", "output_weight", "output_bias",
)  # fmt: skip
"""Sizes of the memory access and of the layers, then addresses of states, vectors and weights."""


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
    lies = arranged(heads, access.usage.shape[-1], x.shape[:-1], LANES)
    old, new = lies.buffers(access), lies.empty(x)
    after = [torch.empty_like(vector) for vector in (h, h, reads)]
    after.append(x.new_empty(*x.shape[:-1], len(weights.output)))
    STEP.run(
        x.dtype, 1, (*lies.sizes, x.shape[-1], h.shape[-1], len(weights.output), clip),
        (*old, *new, *vectors, *after, *weights),
    )  # fmt: skip
    return after, lies.packed(lies.views(new), new)


@kernel
def within(x: Array, limit: int) -> None:
    """Clip to +-limit; NaN stays."""
    for n in range(len(x)):
        if abs(x[n]) > limit:
            x[n] = np.copysign(limit, x[n])


@kernel
def whole_step(number: Any, job: Any, _block: int) -> None:
    """The layers and the memory access, one after the other."""
    inputs, h = job.inputs, job.hidden
    read, size = job.word * job.reads, job.interface_size
    gates, tanhs, interface = np.empty(4 * h, number), np.empty(h, number), np.empty((1, size), number)
    first, final = np.empty(inputs + read + h, number), np.empty(h + read, number)
    first[:inputs] = vector(number, job.x, inputs)
    first[inputs : inputs + read] = vector(number, job.last_reads, read)
    first[inputs + read :] = vector(number, job.h, h)
    apply(matrix(number, job.gate_weight, 4 * h, len(first)), vector(number, job.gate_bias, 4 * h), first, gates)
    squash_sample(
        gates.reshape(-1, LANES), rows(number, job.c, h, 0), rows(number, job.new_h, h, 0),
        rows(number, job.new_c, h, 0), tanhs.reshape(-1, LANES),
    )  # fmt: skip
    final[:h] = vector(number, job.new_h, h)
    apply(
        matrix(number, job.interface_weight, size, h), vector(number, job.interface_bias, size), final[:h],
        interface[0],
    )  # fmt: skip
    reads = vector(number, job.new_reads, read)
    step(
        sizes_of(job), interface, state_of(number, job.old, job.old_links, job, 0),
        state_of(number, job.new, job.new_links, job, 0), reads.reshape(1, read),
        taped(job, np.empty((job.new_lengths_end, LANES), number)),
    )  # fmt: skip
    final[h:] = reads
    y = vector(number, job.y, job.outputs)
    apply(matrix(number, job.output_weight, len(y), len(final)), vector(number, job.output_bias, len(y)), final, y)
    within(vector(number, job.new_c, h), job.clip)
    within(y, job.clip)


STEP = Loop(whole_step, JOB)
