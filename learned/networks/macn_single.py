"""What a MACN makes of one image, without gradients, in one call: the reward map, value iteration, and the features.

For one sample, calls of PyTorch take longer than most of what they do.

Words used here
    H, W    rows and columns of the image
    F       features
"""

from typing import Any, NamedTuple

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # it does
from torch import Tensor

from fogbench.learned.encoding.grid_inputs import Inputs
from fogbench.learned.encoding.grid_sizes import CHANNELS, COMPASS, SEEN
from fogbench.learned.kernels.linear import apply
from fogbench.learned.kernels.native import Loop, job, matrix, pointer, vector
from fogbench.learned.value_iteration.forward import correlate, forward_block
from fogbench.learned.value_iteration.planes import pack, plane_size, planes, unpack
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

JOB = job(
    "height", "width", "iterations", "features", "image", "cell", "sight", "compass",
    "reward_kernels", "reward_bias", "kernels", "weight", "bias", "y",
)  # fmt: skip
"""Sizes, then addresses."""


class Weights(NamedTuple):
    """Of all layers, as the job has them."""

    reward_kernels: Tensor
    """[4, 3, 3, 3] of the collapsed reward map."""
    reward_bias: Tensor
    kernels: Tensor
    """[4, 5, 3, 3] of value iteration."""
    features: Tensor
    """[F, H * W + 4 + SEEN + COMPASS]"""
    feature_bias: Tensor


def see(weights: Weights, iterations: int, inputs: Inputs) -> Tensor:
    """The features [1, F] of what is seen."""
    inputs = Inputs(*(part.contiguous() for part in inputs))
    y = inputs.image.new_empty(1, len(weights.features))
    LOOP.run(y.dtype, 1, (*inputs.image.shape[2:], iterations, y.shape[1]), (*inputs, *weights, y))
    return y


@kernel
def reward_map(image: Array, kernels: Array, bias: Array, scratch: Array, reward: Array) -> None:
    """The reward map of an image, with seven planes of room."""
    channels, width = image.shape[1], image.shape[3]
    terms, plane = scratch[:4], scratch[4]
    plane[:] = 0
    for action in range(4):
        terms[action] = bias[action]
    for channel in range(channels):
        pack(image, channel, 0, plane, 1)
        correlate(terms, kernels[:, channel], plane, width + 1, 1)
    for action in range(4):
        unpack(terms[action], reward, action, 0, 1)


@kernel
def whole(number: Any, job: Any, _block: int) -> None:
    """All of it."""
    height, width, cells = job.height, job.width, job.height * job.width
    scratch = planes(7, plane_size(1, height, width), number)
    q, v = np.empty((1, 4, height, width), number), np.empty((1, height, width), number)
    reward_map(
        carray(pointer(job.image), (1, CHANNELS, height, width), number),
        carray(pointer(job.reward_kernels), (4, CHANNELS, 9), number), vector(number, job.reward_bias, 4),
        scratch, q,
    )  # fmt: skip
    forward_block(
        1, job.iterations, 0, q, carray(pointer(job.kernels), (4, 5, 9), number), q[:0], scratch, scratch[5:],
        np.empty((2, scratch.shape[1]), np.uint8), q, v.reshape((1, 1, height, width)),
    )  # fmt: skip
    told = np.empty(cells + 4 + SEEN + COMPASS, number)
    here = q.reshape((4, cells))[:, carray(pointer(job.cell), (1,), np.int64)[0]]
    told[:cells] = v.reshape(cells)
    told[cells : cells + 4] = here
    told[: cells + 4] -= here.max()
    told[cells + 4 : cells + 4 + SEEN] = vector(number, job.sight, SEEN)
    told[cells + 4 + SEEN :] = vector(number, job.compass, COMPASS)
    y = vector(number, job.y, job.features)
    apply(matrix(number, job.weight, len(y), len(told)), vector(number, job.bias, len(y)), told, y)
    np.maximum(y, 0, y)


LOOP = Loop(whole, JOB)
