"""The usage of the rows, and the write weightings, which prefer rows that are not used; forward and back."""

from typing import Any

import numpy as np

from fogbench.learned.dnc.access import EPSILON, AccessState
from fogbench.learned.dnc.job import Sizes, head_size
from fogbench.learned.kernels.instructions import at, full, put
from fogbench.learned.kernels.lane_arrays import add, unfilled, zeros
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.sorting import gather, ordered, scatter
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array


@fused
def use(sizes: Sizes, read_heads: Array, old: AccessState[Array], usage: Array) -> None:
    """Rows written before are used, rows read before and freed are not."""
    word, rows, readers, writers, _, _, _ = sizes
    size = head_size(read_heads, readers)
    for n in range(rows):
        unused = 1 - at(old.usage, n)
        for i in range(writers):
            unused *= 1 - at(old.write_weights, i * rows + n)
        used = 1 - unused
        for j in range(readers):
            used *= 1 - at(read_heads, j * size + word + 1) * at(old.read_weights, j * rows + n)
        put(usage, n, used)


@fused
def use_back(
    sizes: Sizes, heads: Array, old: AccessState[Array], d_usage: Array, d_heads: Array, d_before: Array,
    d_old_usage: Array,
) -> None:  # fmt: skip
    """Back through `use`, which takes past write weightings as given; adds to `d_before`."""
    word, rows, readers, writers, _, _, _ = sizes
    size = head_size(heads, readers)
    for n in range(rows):
        unwritten = full(heads, 1)
        for i in range(writers):
            unwritten *= 1 - at(old.write_weights, i * rows + n)
        g = at(d_usage, n)
        used, retained = 1 - (1 - at(old.usage, n)) * unwritten, full(heads, 1)
        for j in range(readers):
            free, w = at(heads, j * size + word + 1), at(old.read_weights, j * rows + n)
            lost = g * used
            for k in range(readers):
                if k != j:
                    lost *= 1 - at(heads, k * size + word + 1) * at(old.read_weights, k * rows + n)
            add(d_heads, j * size + word + 1, 0 - lost * w)
            add(d_before, j * rows + n, 0 - lost * free)
            retained *= 1 - free * w
        put(d_old_usage, n, g * unwritten * retained)


@fused
def allocate(sizes: Sizes, heads: Array, usage: Array, similar: Array, before: Array, weights: Array) -> None:
    """The write weightings; a head sees as used what the heads before it are allocated."""
    _, rows, _, writers, _, alone, _ = sizes
    size, used = head_size(heads, writers), unfilled(rows, usage)
    for n in range(rows):
        put(used, n, raised(at(usage, n)))
    for i in range(writers):
        allocation, gate = at(heads, (i + 1) * size - 2), at(heads, (i + 1) * size - 1)
        precede(used, before[i * rows : (i + 1) * rows], alone)
        for n in range(rows):
            k, u = i * rows + n, at(used, n)
            free = (1 - u) * at(before, k)
            put(weights, k, gate * (allocation * free + (1 - allocation) * at(similar, k)))
            put(used, n, u + (1 - u) * allocation * gate * free)


@fused
def allocate_back(
    sizes: Sizes, heads: Array, usage: Array, similar: Array, before: Array, d_weights: Array,
    d_heads: Array, d_similar: Array, d_usage: Array,
) -> None:  # fmt: skip
    """Back through `allocate`, from the last head to the first; adds to `d_usage`."""
    _, rows, _, writers, _, alone, _ = sizes
    size, used, d_used = head_size(heads, writers), unfilled(writers * rows, usage), zeros(usage)
    d_free = unfilled(rows, usage)
    for n in range(rows):
        u = raised(at(usage, n))
        for i in range(writers):
            head = (i + 1) * size
            put(used, i * rows + n, u)
            u += (1 - u) * at(heads, head - 2) * at(heads, head - 1) * (1 - u) * at(before, i * rows + n)
    for i in range(writers - 1, -1, -1):
        head = (i + 1) * size
        allocation, gate = at(heads, head - 2), at(heads, head - 1)
        d_allocation, d_gate, d_both = full(heads, 0), full(heads, 0), full(heads, 0)
        for n in range(rows):
            k = i * rows + n
            u, g, same = at(used, k), at(d_weights, k), at(similar, k)
            free = (1 - u) * at(before, k)
            room = at(d_used, n) * (1 - u)
            d_gate += g * (allocation * free + (1 - allocation) * same)
            d_allocation += g * gate * (free - same)
            d_both += room * free
            put(d_similar, k, g * gate * (1 - allocation))
            put(d_free, n, gate * allocation * (g + room))
            put(d_used, n, at(d_used, n) * (1 - allocation * gate * free))
        put(d_heads, head - 2, d_allocation + d_both * gate)
        put(d_heads, head - 1, d_gate + d_both * allocation)
        precede_back(used[i * rows : (i + 1) * rows], before[i * rows :], d_free, d_used, alone)
    for n in range(rows):
        add(d_usage, n, (1 - EPSILON) * at(d_used, n))


@fused
def raised(usage: Any) -> Any:
    """A usage that is not zero."""
    return EPSILON + (1 - EPSILON) * usage


@fused
def precede(used: Array, before: Array, alone: int) -> None:
    """For each row the product of the usages of the rows less used, or as much and earlier."""
    if alone:
        precede_alone(used, before, alone)
        return
    factors, order = ordered(used)
    product = full(used, 1)
    for k in range(len(used)):
        factor = at(factors, k)
        put(factors, k, product)
        product *= factor
    scatter(factors, order, before)


@kernel
def precede_alone(used: Array, before: Array, rows: int) -> None:
    """The same of one sample."""
    factors, product = used.ravel()[:rows], used.dtype.type(1)
    before[:] = 0
    for k in np.argsort(factors, kind="mergesort"):
        before[k // LANES, k % LANES] = product
        product *= factors[k]


@fused
def precede_back(used: Array, before: Array, d_free: Array, d_used: Array, alone: int) -> None:
    """Back through (1 - used) * before: each usage is a factor for all rows after it; adds to `d_used`."""
    shares = zeros(used)
    for n in range(len(used)):
        put(shares, n, at(d_free, n) * (1 - at(used, n)) * at(before, n))
    if alone:
        add_up_alone(shares, used, alone)
    else:
        add_up(shares, used)
    for n in range(len(used)):
        add(d_used, n, at(shares, n) / at(used, n) - at(d_free, n) * at(before, n))


@fused
def add_up(shares: Array, used: Array) -> None:
    """For each row the sum of the shares of the rows more used, or as much and later."""
    later, order = ordered(used)
    gather(shares, order, later)
    total = full(used, 0)
    for k in range(len(used) - 1, -1, -1):
        share = at(later, k)
        put(later, k, total)
        total += share
    scatter(later, order, shares)


@kernel
def add_up_alone(shares: Array, used: Array, rows: int) -> None:
    """The same of one sample."""
    total = shares.dtype.type(0)
    for k in np.argsort(used.ravel()[:rows], kind="mergesort")[::-1]:
        share = shares[k // LANES, k % LANES]
        shares[k // LANES, k % LANES] = total
        total += share
