"""Weightings by content: which rows are like a key, forward and back."""

from typing import Any

import numpy as np

from fogbench.learned.dnc.access import EPSILON
from fogbench.learned.dnc.job import Sizes, head_size
from fogbench.learned.kernels.instructions import at, full, put, root
from fogbench.learned.kernels.lane_arrays import add, softmax, softmax_back
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array


@fused
def address(sizes: Sizes, count: int, heads: Array, memory: Array, lengths: Array, similar: Array) -> None:
    """The weightings by cosine similarity of keys and rows, and the rows' lengths."""
    word, rows, _, _, _, alone, _ = sizes
    size = head_size(heads, count)
    for n in range(rows):
        put(lengths, n, length(memory[n:], word, rows))
    for i in range(count):
        head, scores = heads[i * size : (i + 1) * size], similar[i * rows : (i + 1) * rows]
        own, strength = length(head, word, 1), at(head, word)
        for n in range(rows):
            put(scores, n, strength * product(head, memory[n:], word, rows) / (own * at(lengths, n) + EPSILON))
        for k in range(alone, alone and rows * LANES):
            scores[k // LANES, k % LANES] = -np.inf
        softmax(scores, alone)


@fused
def address_back(
    sizes: Sizes, count: int, heads: Array, memory: Array, lengths: Array, similar: Array, d_similar: Array,
    d_heads: Array, d_memory: Array,
) -> None:  # fmt: skip
    """Back through `address`; uses `d_similar` up, adds to `d_memory` and to the keys of `d_heads`."""
    word, rows, _, _, _, alone, _ = sizes
    size = head_size(heads, count)
    for i in range(count):
        head, d_head = heads[i * size : (i + 1) * size], d_heads[i * size : (i + 1) * size]
        own, strength = length(head, word, 1), at(head, word)
        d_scores, d_strength, d_own = d_similar[i * rows : (i + 1) * rows], full(heads, 0), full(heads, 0)
        softmax_back(similar[i * rows : (i + 1) * rows], d_scores, alone)
        for n in range(rows):
            share = 1 / (own * at(lengths, n) + EPSILON)
            cosine = share * product(head, memory[n:], word, rows)
            d_product = strength * at(d_scores, n) * share
            d_strength += at(d_scores, n) * cosine
            d_own -= d_product * cosine * at(lengths, n)
            stretch = d_product * cosine * own / at(lengths, n)
            for d in range(word):
                x = at(memory, d * rows + n)
                add(d_head, d, d_product * x)
                add(d_memory, d * rows + n, d_product * at(head, d) - stretch * x)
        put(d_head, word, d_strength)
        for d in range(word):
            add(d_head, d, d_own / own * at(head, d))


@fused
def recall(count: int, heads: Array, similar: Array, weights: Array) -> None:
    """The share of content in the read weightings: a head's last mode."""
    rows, size = len(similar) // count, head_size(heads, count)
    for j in range(count):
        content = at(heads, (j + 1) * size - 1)
        for n in range(j * rows, (j + 1) * rows):
            put(weights, n, content * at(similar, n))


@fused
def recall_back(count: int, heads: Array, similar: Array, d_weights: Array, d_heads: Array, d_similar: Array) -> None:
    """Back through `recall`."""
    rows, size = len(similar) // count, head_size(heads, count)
    for j in range(count):
        content, d_content = at(heads, (j + 1) * size - 1), full(heads, 0)
        for n in range(j * rows, (j + 1) * rows):
            d_content += at(d_weights, n) * at(similar, n)
            put(d_similar, n, content * at(d_weights, n))
        put(d_heads, (j + 1) * size - 1, d_content)


@fused
def length(vector: Array, word: int, pitch: int) -> Any:
    """The norm of `word` numbers, `pitch` apart."""
    square = full(vector, EPSILON)
    for d in range(word):
        square += at(vector, d * pitch) * at(vector, d * pitch)
    return root(square)


@fused
def product(key: Array, vector: Array, word: int, pitch: int) -> Any:
    """The scalar product of a key and `word` numbers, `pitch` apart."""
    total = full(key, 0)
    for d in range(word):
        total += at(key, d) * at(vector, d * pitch)
    return total
