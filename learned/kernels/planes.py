"""Planes: how loops over maps see them, so that the neighbours of all cells are nine shifted views.

Words used here
    L, C     samples of a block, laid side by side: its lanes;  channels of the reward map
    plane    [P] one channel of a block, flat: zeros, then H rows of W cells and one zero cell, then zeros. A cell is L
             numbers, one of each sample. The zero cell that ends a row also stands before the next
    row      (W + 1) * L, the numbers of a row;  P = H * row + 2 * (row + L)
    taps     the nine weights of a 3x3 kernel, row by row

A neighbour is only a shift, so one loop serves any L: with 16 each load of float32 is one cache line, and with 1 it
runs along the rows of a single map.
"""

from typing import Any

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # it does

from fogbench.learned.kernels.native import pointer
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array

LINE = 64
"""Bytes of a cache line."""


@kernel
def plane_size(lanes: int, height: int, width: int) -> int:
    """How many numbers a plane has: P."""
    return (height + 2) * (width + 1) * lanes + 2 * lanes


@kernel
def planes(count: int, size: int, dtype: Any) -> Array:
    """[count, P] room, from the start of a cache line on."""
    memory = np.empty(count * size + LINE, dtype)
    start = -memory.ctypes.data % LINE // memory.itemsize
    return memory[start : start + count * size].reshape((count, size))


@kernel
def lent(room: Array) -> Array:
    """The same room [m, n] for loops that slice it often: who has it is not counted, so its owner must outlive them."""
    return carray(pointer(room.ctypes.data), room.shape, room.dtype)


@kernel
def pack(maps: Array, channel: int, first: int, plane: Array, lanes: int) -> None:
    """Lay a channel of the samples from `first` on, of maps [B, C, H, W], side by side into a plane.

    Line by line of the plane: sample by sample takes four times as long on maps of 32x32.
    """
    height, width = maps.shape[2:]
    cells = cells_of(plane, lanes, height, width)
    samples = maps[first : first + lanes, channel]
    for y in range(height):
        for x in range(width):
            for lane in range(len(samples)):
                cells[y + 1, x + 1, lane] = samples[lane, y, x]


@kernel
def unpack(plane: Array, maps: Array, channel: int, first: int, lanes: int) -> None:
    """Undo `pack`."""
    height, width = maps.shape[2:]
    cells = cells_of(plane, lanes, height, width)
    for lane in range(min(lanes, len(maps) - first)):
        for y in range(height):
            for x in range(width):
                maps[first + lane, channel, y, x] = cells[y + 1, x + 1, lane]


@kernel
def clear(plane: Array, lanes: int, height: int, width: int) -> None:
    """Set to zero all that is no cell of a map."""
    cells = cells_of(plane, lanes, height, width)
    cells[0] = 0
    cells[1:, 0] = 0
    cells[height + 1] = 0
    plane[len(plane) - 2 * lanes :] = 0


@kernel
def cells_of(plane: Array, lanes: int, height: int, width: int) -> Array:
    """[H + 2, W + 1, L] a plane as rows of cells, cell (y, x) of the maps at (y + 1, x + 1)."""
    return plane[: (height + 2) * (width + 1) * lanes].reshape((height + 2, width + 1, lanes))


@kernel
def neighbours(plane: Array, row: int, lanes: int) -> tuple[Array, ...]:
    """Nine views of a plane; number j of each is the same cell's neighbour in that direction."""
    top, middle, bottom = plane, plane[row:], plane[2 * row :]
    return (
        top, top[lanes:], top[2 * lanes :],
        middle, middle[lanes:], middle[2 * lanes :],
        bottom, bottom[lanes:], bottom[2 * lanes :],
    )  # fmt: skip


@kernel
def at(x: tuple[Array, ...], j: int) -> tuple[float, ...]:
    """Number j of nine views."""
    return x[0][j], x[1][j], x[2][j], x[3][j], x[4][j], x[5][j], x[6][j], x[7][j], x[8][j]


@kernel
def taps(w: Array) -> tuple[float, ...]:
    """Nine weights, in registers."""
    return w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7], w[8]


@fused
def plus(start: float, w: tuple[float, ...], x: tuple[float, ...]) -> float:
    """A number and nine products: nine instructions, where a sum of the products that is added takes ten."""
    return (
        start
        + w[0] * x[0] + w[1] * x[1] + w[2] * x[2]
        + w[3] * x[3] + w[4] * x[4] + w[5] * x[5]
        + w[6] * x[6] + w[7] * x[7] + w[8] * x[8]
    )  # fmt: skip
