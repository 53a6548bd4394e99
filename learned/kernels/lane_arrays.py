"""Arrays of lanes, which kernels of several files fill, lay side by side or make distributions."""

from typing import Any

import numpy as np

from fogbench.learned.kernels.functions import decay, larger
from fogbench.learned.kernels.instructions import at, full, put
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array


@kernel
def clear(rows: Array) -> None:
    """All rows become zero."""
    for n in range(len(rows)):
        put(rows, n, full(rows, 0))


@kernel
def zeros(rows: Array) -> Array:
    """New rows of zeros, as many as there are rows."""
    new = np.empty((len(rows), LANES), rows.dtype)
    clear(new)
    return new


@kernel
def same(rows: Array) -> Array:
    """A copy of the rows."""
    new = np.empty((len(rows), LANES), rows.dtype)
    for n in range(len(rows)):
        put(new, n, at(rows, n))
    return new


@kernel
def add(rows: Array, index: int, x: Any) -> None:
    """Add to one row."""
    put(rows, index, at(rows, index) + x)


@kernel
def lay(samples: Array, rows: Array) -> None:
    """Samples side by side: [samples, any] becomes [any, samples], with zeros where a block is not full."""
    for k in range(rows.shape[0]):
        put(rows, k, full(rows, 0))
    for lane in range(samples.shape[0]):
        for k in range(rows.shape[0]):
            rows[k, lane] = samples[lane, k]


@kernel
def unlay(rows: Array, samples: Array) -> None:
    """Undo `lay`."""
    for lane in range(samples.shape[0]):
        for k in range(rows.shape[0]):
            samples[lane, k] = rows[k, lane]


@fused
def softmax(scores: Array) -> None:
    """Scores become a distribution."""
    highest = at(scores, 0)
    for n in range(1, len(scores)):
        highest = larger(highest, at(scores, n))
    total = full(scores, 0)
    for n in range(len(scores)):
        e = decay(at(scores, n) - highest)
        total += e
        put(scores, n, e)
    share = 1 / total
    for n in range(len(scores)):
        put(scores, n, at(scores, n) * share)


@fused
def softmax_back(shares: Array, d: Array) -> None:
    """Gradients by a distribution become those by its scores."""
    mean = full(shares, 0)
    for n in range(len(shares)):
        mean += at(shares, n) * at(d, n)
    for n in range(len(shares)):
        put(d, n, at(shares, n) * (at(d, n) - mean))
