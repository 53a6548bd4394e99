"""The jobs of value iteration, and the arrays that their addresses stand for.

    lanes               samples of a block; the last block may have fewer
    batch, channels, height, width, iterations      B, C, H, W and K, at least 1
    reward              [B, C, H, W]
    weights             [4, C + 1, 9], the value's taps last
    barrier             [B, 4, H, W] added to Q in every iteration, or 0 for none
    values, choices     [blocks, K, P] the value after each iteration, and uint8, the action that gave it; or 0 for none
    q, v                [B, 4, H, W] the last Q, and [B, H, W] its maximum over the actions
    d...                gradients, shaped like what they are by, but `dweights` [blocks, 4, C + 1, 9], each block's part

The letters are those of `fogbench.learned.kernels.planes`. From `reward` on they are addresses.
"""

from typing import Any

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # it does

from fogbench.learned.kernels.native import job, pointer
from fogbench.learned.kernels.planes import plane_size
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

SIZES = ("lanes", "batch", "channels", "height", "width", "iterations")
FORWARD_JOB = job(*SIZES, "reward", "weights", "barrier", "values", "choices", "q", "v")
BACKWARD_JOB = job(*SIZES, "reward", "weights", "values", "choices", "dq", "dv", "dreward", "dbarrier", "dweights")


@kernel
def maps_of(number: Any, address: int, channels: int, job: Any) -> Array:
    """[B, channels, H, W] the maps at an address; [0, channels, H, W] if that is 0."""
    return carray(pointer(address), (job.batch if address else 0, channels, job.height, job.width), number)


@kernel
def weights_of(number: Any, address: int, block: int, job: Any) -> Array:
    """[4, C + 1, 9] a block's weights, or a gradient by them."""
    weights: Array = carray(pointer(address), (block + 1, 4, job.channels + 1, 9), number)[block]
    return weights


@kernel
def history_of(number: Any, block: int, job: Any) -> tuple[Array, Array]:
    """[K, P] a block's values, and its choices."""
    shape = block + 1, job.iterations, plane_size(job.lanes, job.height, job.width)
    return carray(pointer(job.values), shape, number)[block], carray(pointer(job.choices), shape, np.uint8)[block]
