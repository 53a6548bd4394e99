"""Heads write to the rows of the memory and read from them, forward and back."""

import numpy as np

from fogbench.learned.dnc.job import Sizes, head_size
from fogbench.learned.kernels.instructions import at, full, put
from fogbench.learned.kernels.lane_arrays import add, lay, over
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array


@fused
def write(sizes: Sizes, heads: Array, memory: Array, weights: Array, new_memory: Array) -> None:
    """All heads erase, then all add."""
    word, rows, _, writers, _, _, _ = sizes
    size = head_size(heads, writers)
    for d in range(word):
        for n in range(rows):
            kept, added = at(memory, d * rows + n), full(memory, 0)
            for i in range(writers):
                head, w = i * size, at(weights, i * rows + n)
                kept *= 1 - at(heads, head + 2 * word + 1 + d) * w
                added += at(heads, head + word + 1 + d) * w
            put(new_memory, d * rows + n, kept + added)


@fused
def write_back(
    sizes: Sizes, heads: Array, memory: Array, weights: Array, d_new_memory: Array, d_heads: Array, d_memory: Array,
    d_weights: Array,
) -> None:  # fmt: skip
    """Back through `write`; adds to `d_weights`."""
    word, rows, _, writers, _, _, _ = sizes
    size = head_size(heads, writers)
    for d in range(word):
        value, erase = word + 1 + d, 2 * word + 1 + d
        for n in range(rows):
            g, x = at(d_new_memory, d * rows + n), at(memory, d * rows + n)
            kept = full(memory, 1)
            for i in range(writers):
                w = at(weights, i * rows + n)
                lost = g * x
                for k in range(writers):
                    if k != i:
                        lost *= 1 - at(heads, k * size + erase) * at(weights, k * rows + n)
                add(d_heads, i * size + erase, 0 - lost * w)
                add(d_heads, i * size + value, g * w)
                add(d_weights, i * rows + n, g * at(heads, i * size + value) - lost * at(heads, i * size + erase))
                kept *= 1 - at(heads, i * size + erase) * w
            put(d_memory, d * rows + n, g * kept)


@fused
def read(sizes: Sizes, memory: Array, weights: Array, reads: Array) -> None:
    """Each read head reads the sum of the rows, times its weights."""
    word, rows, readers, _, _, alone, _ = sizes
    sums = np.empty((1, LANES), memory.dtype)
    for j in range(readers):
        for d in range(word):
            total = full(memory, 0)
            for n in range(rows):
                total += at(weights, j * rows + n) * at(memory, d * rows + n)
            put(sums, 0, over(total, sums, alone))
            for lane in range(len(reads)):
                reads[lane, j * word + d] = sums[0, lane]


@fused
def read_back(sizes: Sizes, memory: Array, weights: Array, d_samples: Array, d_memory: Array, d_weights: Array) -> None:
    """Back through `read`; adds to `d_memory` and `d_weights`."""
    word, rows, readers, _, _, alone, _ = sizes
    d_reads = np.empty((readers * word, LANES), memory.dtype)
    lay(d_samples, d_reads, alone)
    for j in range(readers):
        for d in range(word):
            g = at(d_reads, j * word + d)
            for n in range(rows):
                add(d_weights, j * rows + n, g * at(memory, d * rows + n))
                add(d_memory, d * rows + n, g * at(weights, j * rows + n))
