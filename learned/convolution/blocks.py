"""Four convolutions of a block of sixteen samples, forward and back; the words are those of the file `loops`.

Words used here
    I, C, O    channels of the image, of the first three convolutions, and of the last
    tape       [(3 * C + O) * P, 16] what each of the four made
"""

from typing import Any

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # it does

from fogbench.learned.convolution.loops import bias_back, convolve, convolve_back, weigh
from fogbench.learned.kernels.instructions import at, put, total, until
from fogbench.learned.kernels.lane_arrays import clear
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.native import Loop, job, pointer, vector
from fogbench.learned.kernels.planes import pack, plane_size, unpack
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array

SIZES = "samples", "height", "width", "inputs", "channels", "outputs", "weights_size", "biases_size"
FORWARD_JOB = job(*SIZES, "image", "weights", "biases", "tape", "y")
"""Sizes, then addresses: image [B, I, H, W]; weights and biases of all four, one after the other; a tape for each
block; y [B, O, H, W]."""
BACKWARD_JOB = job(*SIZES, "image", "weights", "tape", "d_y", "d_weights", "d_biases")
"""Gradients by weights and biases have a row for each block."""


@kernel
def lay_maps(maps: Array, planes: Array) -> None:
    """Maps [samples, channels, H, W] become planes."""
    channels = maps.shape[1]
    clear(planes)
    for channel in range(channels):
        pack(maps, channel, 0, plane_of(planes, channel, channels), LANES)


@kernel
def plane_of(planes: Array, channel: int, channels: int) -> Array:
    """One of some planes, flat."""
    size = len(planes) // channels
    return planes[channel * size : (channel + 1) * size].reshape(-1)


@kernel
def unlay_maps(planes: Array, maps: Array) -> None:
    """Undo `lay_maps`."""
    channels = maps.shape[1]
    for channel in range(channels):
        unpack(plane_of(planes, channel, channels), maps, channel, 0, LANES)


@kernel
def maps_of(number: Any, address: int, channels: int, job: Any, block: int) -> Array:
    """[at most 16, channels, H, W] the samples of a block."""
    maps = carray(pointer(address), (job.samples, channels, job.height, job.width), number)
    return maps[block * LANES : (block + 1) * LANES]


@kernel
def tape_of(number: Any, job: Any, block: int) -> Array:
    """The tape of a block."""
    rows = job.biases_size * plane_size(1, job.height, job.width)
    return carray(pointer(job.tape), ((block + 1) * rows, LANES), number)[block * rows :]


@kernel
def forward_room(number: Any, job: Any) -> tuple[Array]:
    """Planes for an image."""
    return (np.zeros((job.inputs * plane_size(1, job.height, job.width), LANES), number),)


@kernel
def forward(number: Any, job: Any, block: int, before: Array) -> None:
    """Four convolutions of a block."""
    size, row = plane_size(1, job.height, job.width), job.width + 1
    lay_maps(maps_of(number, job.image, job.inputs, job, block), before)
    tape = tape_of(number, job, block)
    weights = vector(number, job.weights, job.weights_size)
    biases = vector(number, job.biases, job.biases_size)
    x, inputs, start, weight = before, job.inputs, 0, 0
    for outputs in (job.channels, job.channels, job.channels, job.outputs):
        y = tape[start * size : (start + outputs) * size]
        convolve(x, inputs, weights[weight:], biases[start : start + outputs], size, row, y)
        x, weight, start, inputs = y, weight + outputs * inputs * 9, start + outputs, outputs
    unlay_maps(x, maps_of(number, job.y, job.outputs, job, block))


@kernel
def backward_room(number: Any, job: Any) -> tuple[Array, ...]:
    """Planes for an image, for two gradients, and the gradients by weights and biases."""
    size, most = plane_size(1, job.height, job.width), max(job.channels, job.outputs)
    return (
        np.zeros((job.inputs * size, LANES), number), np.zeros((most * size, LANES), number),
        np.zeros((most * size, LANES), number), np.zeros((job.weights_size, LANES), number),
        np.zeros((job.biases_size, LANES), number),
    )  # fmt: skip


@kernel
def backward(
    number: Any, job: Any, block: int, image: Array, one: Array, other: Array, d_weights: Array, d_biases: Array
) -> None:
    """Back through four convolutions of a block."""
    size, row, channels = plane_size(1, job.height, job.width), job.width + 1, job.channels
    lay_maps(maps_of(number, job.image, job.inputs, job, block), image)
    tape = tape_of(number, job, block)
    clear(d_weights)
    clear(d_biases)
    d = one[: job.outputs * size]
    lay_maps(maps_of(number, job.d_y, job.outputs, job, block), d)
    rectify_back(tape[3 * channels * size :], d)
    weights = vector(number, job.weights, job.weights_size)
    weight, outputs, d_x = job.weights_size, job.outputs, other
    for layer in (3, 2, 1):
        weight -= outputs * channels * 9
        x = tape[(layer - 1) * channels * size : layer * channels * size]
        weigh(x, channels, d, size, row, d_weights[weight:])
        bias_back(d, size, d_biases[layer * channels :])
        d_x = d_x[: channels * size]
        convolve_back(d, outputs, weights[weight:], x, size, row, d_x)
        d, d_x, outputs = d_x, (one if layer % 2 else other), channels
    weigh(image, job.inputs, d, size, row, d_weights)
    bias_back(d, size, d_biases)
    gather_lanes(d_weights, vector_of(number, job.d_weights, job.weights_size, block))
    gather_lanes(d_biases, vector_of(number, job.d_biases, job.biases_size, block))


@kernel
def vector_of(number: Any, address: int, size: int, block: int) -> Array:
    """A block's row of a matrix [blocks, size]."""
    return vector(number, address, (block + 1) * size)[block * size :]


@fused
def rectify_back(y: Array, d: Array) -> None:
    """Where `y` is zero the gradient by it becomes zero."""
    for n in range(len(d)):
        put(d, n, until(at(y, n), 0, 0, at(d, n)))


@fused
def gather_lanes(rows: Array, sums: Array) -> None:
    """The sums over all lanes."""
    for n in range(len(rows)):
        sums[n] = total(at(rows, n))


FORWARD, BACKWARD = Loop(forward, FORWARD_JOB, forward_room), Loop(backward, BACKWARD_JOB, backward_room)
