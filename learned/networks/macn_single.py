"""What a MACN makes of one image, without gradients, in one call: values, convolutions, and the features of both.

For one sample, calls of PyTorch take longer than most of what they do.

Words used here
    H, W    rows and columns of the image;  S of the cells around the agent
    F       features
    C       channels of the convolutions; 0 without them
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import torch
from numba import carray  # type: ignore[attr-defined]  # it does
from torch import Tensor
from torch.nn.functional import pad

from fogbench.learned.cnn_memory import LAST
from fogbench.learned.encoding.grid_inputs import Inputs
from fogbench.learned.encoding.grid_sizes import CHANNELS, COMPASS, SEEN, SIGHT
from fogbench.learned.kernels.convolution import convolve
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.linear import apply
from fogbench.learned.kernels.native import Loop, job, matrix, pointer, vector
from fogbench.learned.kernels.planes import pack, plane_size, planes, unpack
from fogbench.learned.value_iteration.forward import correlate, forward_block
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

JOB = job(
    "height", "width", "iterations", "features", "channels", "weights", "image", "cell", "sight",
    "compass", "reward_kernels", "reward_bias", "kernels", "weight", "bias", "convolutions", "y",
)  # fmt: skip
"""Sizes, then addresses."""

SIDE = 2 * SIGHT + 1
"""S"""


class Weights(NamedTuple):
    """Of all layers, as the job has them."""

    reward_kernels: Tensor
    """[4, 3, 3, 3] of the collapsed reward map."""
    reward_bias: Tensor
    kernels: Tensor
    """[4, 5, 3, 3] of value iteration."""
    features: Tensor
    """[F, H * W + 4 + SEEN + COMPASS], or with 4 * S * S more before SEEN"""
    feature_bias: Tensor
    convolutions: Tensor
    """[any, 16] of each convolution its kernels and its bias, as `convolve` takes them"""
    channels: int
    """C"""


def see(weights: Weights, iterations: int, inputs: Inputs) -> Tensor:
    """The features [1, F] of what is seen."""
    inputs = Inputs(*(part.contiguous() for part in inputs))
    y = inputs.image.new_empty(1, len(weights.features))
    *tensors, channels = weights
    sizes = *inputs.image.shape[2:], iterations, y.shape[1], channels, len(weights.convolutions)
    LOOP.run(y.dtype, 1, sizes, (*inputs, *tensors, y))
    return y


def in_lanes(convolutions: Sequence[Tensor]) -> tuple[Tensor, int]:
    """The convolutions and the channels of `Weights`, from kernels and bias in turn, or from none."""
    parts = []
    for kernels, bias in zip(convolutions[::2], convolutions[1::2], strict=True):
        more = -len(bias) % LANES
        lanes = pad(kernels.flatten(2).permute(2, 1, 0), (0, more))  # [9, inputs, outputs]
        blocks = lanes.reshape(*lanes.shape[:2], -1, LANES).movedim(2, 0)
        parts += [blocks.reshape(-1, LANES), pad(bias, (0, more)).reshape(-1, LANES)]
    return (torch.cat(parts), len(convolutions[0])) if parts else (torch.empty(0, LANES), 0)


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
def convolved(sight: Array, weights: Array, channels: int, maps: Array) -> None:
    """Four convolutions of the cells around the agent [CHANNELS, S, S], into maps [LAST, S, S]."""
    row, filled = SIDE + 1, -(-channels // LANES) * LANES
    room = np.zeros((2, (SIDE + 2) * row + 2, filled), sight.dtype)
    before, after = room[0], room[1]
    cells = before[:-2].reshape((SIDE + 2, row, filled))[1:-1, 1:]  # [S, S, filled]
    cells[:, :, :CHANNELS] = sight.transpose((1, 2, 0))
    start, inputs = 0, CHANNELS
    for outputs in (channels, channels, channels, LAST):
        blocks = -(-outputs // LANES)
        end = start + blocks * 9 * inputs
        convolve(before, weights[start:end], weights[end : end + blocks], row, after)
        before, after, inputs, start = after, before, outputs, end + blocks
    maps[:] = cells[:, :, :LAST].transpose((2, 0, 1))  # after an even number of turns


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
    seen = cells + 4 + (LAST * SIDE * SIDE if job.channels else 0)
    told = np.empty(seen + SEEN + COMPASS, number)
    here = q.reshape((4, cells))[:, carray(pointer(job.cell), (1,), np.int64)[0]]
    told[:cells] = v.reshape(cells)
    told[cells : cells + 4] = here
    told[: cells + 4] -= here.max()
    if job.channels:
        convolved(
            carray(pointer(job.sight), (CHANNELS, SIDE, SIDE), number),
            matrix(number, job.convolutions, job.weights, LANES), job.channels,
            told[cells + 4 : seen].reshape((LAST, SIDE, SIDE)),
        )  # fmt: skip
    told[seen : seen + SEEN] = vector(number, job.sight, SEEN)
    told[seen + SEEN :] = vector(number, job.compass, COMPASS)
    y = vector(number, job.y, job.features)
    apply(matrix(number, job.weight, len(y), len(told)), vector(number, job.bias, len(y)), told, y)
    np.maximum(y, 0, y)


LOOP = Loop(whole, JOB)
