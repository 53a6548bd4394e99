"""Arrays of lanes, which kernels of several files fill, lay side by side or make distributions."""

from typing import Any

from fogbench.learned.kernels.functions import decay, larger
from fogbench.learned.kernels.instructions import at, full, largest, put, total
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.planes import planes
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array


@kernel
def clear(rows: Array) -> None:
    """All rows become zero."""
    for n in range(len(rows)):
        put(rows, n, full(rows, 0))


@kernel
def unfilled(count: int, like: Array) -> Array:
    """So many new rows, each of its own cache lines."""
    return planes(count, LANES, like.dtype)


@kernel
def zeros(rows: Array) -> Array:
    """New rows of zeros, as many as there are rows."""
    new = unfilled(len(rows), rows)
    clear(new)
    return new


@kernel
def same(rows: Array) -> Array:
    """A copy of the rows."""
    new = unfilled(len(rows), rows)
    for n in range(len(rows)):
        put(new, n, at(rows, n))
    return new


@kernel
def add(rows: Array, index: int, x: Any) -> None:
    """Add to one row."""
    put(rows, index, at(rows, index) + x)


@kernel
def lay(samples: Array, rows: Array, alone: int) -> None:
    """Samples side by side: [samples, any] becomes [any, samples], with zeros where a block is not full.

    Of one sample alone each number is in all lanes.
    """
    if alone:
        for k in range(rows.shape[0]):
            put(rows, k, full(rows, samples[0, k]))
        return
    for k in range(rows.shape[0]):
        put(rows, k, full(rows, 0))
    for lane in range(samples.shape[0]):
        for k in range(rows.shape[0]):
            rows[k, lane] = samples[lane, k]


@kernel
def unlay(rows: Array, samples: Array, alone: int) -> None:
    """Undo `lay`; of one sample alone each number is the sum of its row."""
    if alone:
        for k in range(rows.shape[0]):
            samples[0, k] = total(at(rows, k))
        return
    for lane in range(samples.shape[0]):
        for k in range(rows.shape[0]):
            samples[lane, k] = rows[k, lane]


@fused
def softmax(scores: Array, alone: int) -> None:
    """Scores become a distribution in each lane, or a single one in all lanes."""
    highest = at(scores, 0)
    for n in range(1, len(scores)):
        highest = larger(highest, at(scores, n))
    if alone:
        highest = full(scores, largest(highest))
    sum_ = full(scores, 0)
    for n in range(len(scores)):
        e = decay(at(scores, n) - highest)
        sum_ += e
        put(scores, n, e)
    share = 1 / over(sum_, scores, alone)
    for n in range(len(scores)):
        put(scores, n, at(scores, n) * share)


@kernel
def over(sums: Any, rows: Array, alone: int) -> Any:
    """The sums over rows, of which each lane has its own, or all have a share."""
    return full(rows, total(sums)) if alone else sums


@fused
def softmax_back(shares: Array, d: Array, alone: int) -> None:
    """Gradients by a distribution become those by its scores."""
    mean = full(shares, 0)
    for n in range(len(shares)):
        mean += at(shares, n) * at(d, n)
    mean = over(mean, shares, alone)
    for n in range(len(shares)):
        put(d, n, at(shares, n) * (at(d, n) - mean))
