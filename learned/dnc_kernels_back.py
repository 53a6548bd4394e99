"""The way back through `learned.dnc_kernels`, function by function, in its words.

Words used here
    d_x    the gradient of the loss by x
"""

from functools import lru_cache
from typing import Any

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # it does

from learned.dnc_access import EPSILON, AccessState
from learned.dnc_kernels import (
    JOB,
    Sizes,
    Tape,
    along,
    interface_size,
    lay,
    length,
    link,
    product,
    raised,
    samples_of,
    sizes_of,
    state_of,
    tape_of,
)  # fmt: skip
from learned.lanes import LANES, at, decay, full, put, until
from learned.native import take
from worlds.kernel import callback, fused, kernel
from worlds.types import Array


@lru_cache
def backward(number: type[np.floating[Any]]) -> int:
    """The address of the loop back through one step, which needs all fields of the job but `new_links`.

    The past write weightings get zeros.
    """

    def loop(address: Any) -> None:
        job = carray(address, 1, JOB)[0]
        sizes = sizes_of(job)
        block = take(address)
        while block < job.blocks:
            old = state_of(number, job.old, job.old_links, job, block)
            new = state_of(number, job.new, job.old_links, job, block)
            d_new = state_of(number, job.d_new, job.d_new_links, job, block)
            d_old = state_of(number, job.d_old, job.d_old_links, job, block)
            d_reads = samples_of(number, job.d_read, job.reads * job.word, job, block)
            d_interface = samples_of(number, job.d_interface, interface_size(sizes), job, block)
            step_back(sizes, old, new, tape_of(number, job, block), d_reads, d_new, d_old, d_interface)
            block = take(address)

    return callback(loop)


@lru_cache
def relink(number: type[np.floating[Any]]) -> int:
    """The address of the loop that makes `new_links` again from `old`, `old_links` and `new`."""

    def loop(address: Any) -> None:
        job = carray(address, 1, JOB)[0]
        block = take(address)
        while block < job.blocks:
            old = state_of(number, job.old, job.old_links, job, block)
            new = state_of(number, job.new, job.new_links, job, block)
            precedence = np.empty((job.linked * job.rows, LANES), number)
            link(job.linked, old.links, old.precedence, new.write_weights, new.links, precedence)
            block = take(address)

    return callback(loop)


@kernel
def step_back(
    sizes: Sizes, old: AccessState[Array], new: AccessState[Array], tape: Tape, d_reads: Array,
    d_new: AccessState[Array], d_old: AccessState[Array], d_interface: Array,
) -> None:  # fmt: skip
    """Back through one step of one block. The links of `new` are not looked at."""
    word, rows, readers, writers, linked = sizes
    number = tape.before.dtype
    links, precedence = np.empty((linked * rows * rows, LANES), number), np.empty((linked * rows, LANES), number)
    link(linked, old.links, old.precedence, new.write_weights, links, precedence)
    d_write_heads, d_read_heads = zeros(tape.write_heads), zeros(tape.read_heads)
    d_memory, d_usage = same(d_new.memory), same(d_new.usage)
    d_read, d_write = same(d_new.read_weights), same(d_new.write_weights)
    d_read_similar, d_write_similar = zeros(d_read), zeros(d_write)
    for part in (d_old.memory, d_old.read_weights, d_old.write_weights, d_old.precedence):
        clear(part)
    read_back(sizes, new.memory, new.read_weights, d_reads, d_memory, d_read)
    follow_back(
        sizes, tape.read_heads, links, old.read_weights, tape.read_similar, d_read,
        d_read_heads, d_old.read_weights, d_read_similar,
    )  # fmt: skip
    link_back(sizes, tape.read_heads, old, new.write_weights, d_read, d_new, d_old, d_write)
    address_back(
        word, readers, tape.read_heads, new.memory, tape.new_lengths, tape.read_similar, d_read_similar,
        d_read_heads, d_memory,
    )  # fmt: skip
    write_back(sizes, tape.write_heads, old.memory, new.write_weights, d_memory, d_write_heads, d_old.memory, d_write)
    allocate_back(
        sizes, tape.write_heads, new.usage, tape.write_similar, tape.before, d_write,
        d_write_heads, d_write_similar, d_usage,
    )  # fmt: skip
    address_back(
        word, writers, tape.write_heads, old.memory, tape.old_lengths, tape.write_similar, d_write_similar,
        d_write_heads, d_old.memory,
    )  # fmt: skip
    use_back(sizes, tape.read_heads, old, d_usage, d_read_heads, d_old.read_weights, d_old.usage)
    activate_back(sizes, tape.write_heads, tape.read_heads, d_write_heads, d_read_heads, d_interface)


@kernel
def clear(rows: Array) -> None:
    """Make all zero."""
    for n in range(len(rows)):
        put(rows, n, full(rows, 0))


@kernel
def zeros(rows: Array) -> Array:
    """As many rows of zeros."""
    new = np.empty((len(rows), LANES), rows.dtype)
    clear(new)
    return new


@kernel
def same(rows: Array) -> Array:
    """The same once more."""
    new = np.empty((len(rows), LANES), rows.dtype)
    for n in range(len(rows)):
        put(new, n, at(rows, n))
    return new


@kernel
def add(rows: Array, index: int, x: Any) -> None:
    """Add to one row."""
    put(rows, index, at(rows, index) + x)


@fused
def read_back(sizes: Sizes, memory: Array, weights: Array, d_samples: Array, d_memory: Array, d_weights: Array) -> None:
    """Back through `read`; adds to `d_memory` and `d_weights`."""
    word, rows, readers, _, _ = sizes
    d_reads = np.empty((readers * word, LANES), memory.dtype)
    lay(d_samples, d_reads)
    for j in range(readers):
        for d in range(word):
            g = at(d_reads, j * word + d)
            for n in range(rows):
                add(d_weights, j * rows + n, g * at(memory, d * rows + n))
                add(d_memory, d * rows + n, g * at(weights, j * rows + n))


@fused
def follow_back(
    sizes: Sizes, heads: Array, links: Array, before: Array, similar: Array, d_weights: Array,
    d_heads: Array, d_before: Array, d_similar: Array,
) -> None:  # fmt: skip
    """Back through `follow`, but not to the links; adds to `d_before`."""
    word, rows, readers, _, linked = sizes
    size = word + 2 * linked + 3
    ahead, back = np.empty((readers * rows, LANES), before.dtype), np.empty((readers * rows, LANES), before.dtype)
    for j in range(readers):
        content, d_content = at(heads, (j + 1) * size - 1), full(heads, 0)
        for n in range(j * rows, (j + 1) * rows):
            d_content += at(d_weights, n) * at(similar, n)
            put(d_similar, n, content * at(d_weights, n))
        put(d_heads, (j + 1) * size - 1, d_content)
    for i in range(linked):
        along(rows, readers, links[i * rows * rows :], d_weights, ahead, back)
        for j in range(readers):
            mode = j * size + word + 2 + i
            backward, forward = at(heads, mode), at(heads, mode + linked)
            d_backward, d_forward = full(heads, 0), full(heads, 0)
            for n in range(j * rows, (j + 1) * rows):
                d_backward += at(before, n) * at(ahead, n)
                d_forward += at(before, n) * at(back, n)
                add(d_before, n, backward * at(ahead, n) + forward * at(back, n))
            put(d_heads, mode, d_backward)
            put(d_heads, mode + linked, d_forward)


@fused
def link_back(
    sizes: Sizes, heads: Array, old: AccessState[Array], weights: Array, d_read: Array, d_new: AccessState[Array],
    d_old: AccessState[Array], d_weights: Array,
) -> None:  # fmt: skip
    """Back through `link`, with what `follow` asks of the links; adds to `d_weights` and the old precedence's."""
    word, rows, readers, _, linked = sizes
    size = word + 2 * linked + 3
    before = old.read_weights
    onward, ago = np.empty((readers, LANES), weights.dtype), np.empty((readers, LANES), weights.dtype)
    for i in range(linked):
        w, p, d_precedence = weights[i * rows :], old.precedence[i * rows :], d_new.precedence[i * rows :]
        d_w, d_p = d_weights[i * rows :], d_old.precedence[i * rows :]
        kept, lost = full(weights, 1), full(weights, 0)
        for n in range(rows):
            kept -= at(w, n)
            lost += at(d_precedence, n) * at(p, n)
        for n in range(rows):
            add(d_p, n, kept * at(d_precedence, n))
            add(d_w, n, at(d_precedence, n) - lost)
        for n in range(rows):
            for j in range(readers):
                mode = j * size + word + 2 + i
                put(ago, j, at(heads, mode) * at(before, j * rows + n))
                put(onward, j, at(heads, mode + linked) * at(d_read, j * rows + n))
            to, d_to, first = at(w, n), full(weights, 0), (i * rows + n) * rows
            for m in range(rows):
                d_link = at(d_new.links, first + m)
                for j in range(readers):
                    d_link += at(onward, j) * at(before, j * rows + m) + at(ago, j) * at(d_read, j * rows + m)
                if m == n:
                    d_link = full(weights, 0)
                lost = d_link * at(old.links, first + m)
                put(d_old.links, first + m, (1 - to - at(w, m)) * d_link)
                add(d_w, m, 0 - lost)
                add(d_p, m, to * d_link)
                d_to += d_link * at(p, m) - lost
            add(d_w, n, d_to)


@fused
def address_back(
    word: int, count: int, heads: Array, memory: Array, lengths: Array, similar: Array, d_similar: Array,
    d_heads: Array, d_memory: Array,
) -> None:  # fmt: skip
    """Back through `address`; adds to `d_memory` and to the keys' part of `d_heads`."""
    rows, size = len(lengths), len(heads) // count
    for i in range(count):
        head, d_head = heads[i * size : (i + 1) * size], d_heads[i * size : (i + 1) * size]
        own, strength = length(head, word, 1), at(head, word)
        mean, d_strength, d_own = full(heads, 0), full(heads, 0), full(heads, 0)
        for n in range(i * rows, (i + 1) * rows):
            mean += at(similar, n) * at(d_similar, n)
        for n in range(rows):
            share = 1 / (own * at(lengths, n) + EPSILON)
            cosine = share * product(head, memory[n:], word, rows)
            d_score = at(similar, i * rows + n) * (at(d_similar, i * rows + n) - mean)
            d_product = strength * d_score * share
            d_strength += d_score * cosine
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
def write_back(
    sizes: Sizes, heads: Array, memory: Array, weights: Array, d_new_memory: Array, d_heads: Array, d_memory: Array,
    d_weights: Array,
) -> None:  # fmt: skip
    """Back through `write`; adds to `d_weights`."""
    word, rows, _, writers, _ = sizes
    size = 3 * word + 3
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
def allocate_back(
    sizes: Sizes, heads: Array, usage: Array, similar: Array, before: Array, d_weights: Array,
    d_heads: Array, d_similar: Array, d_usage: Array,
) -> None:  # fmt: skip
    """Back through `allocate`, from the last head to the first; adds to `d_usage`."""
    word, rows, _, writers, _ = sizes
    used, d_used = np.empty((writers * rows, LANES), usage.dtype), zeros(usage)
    d_free = np.empty((rows, LANES), usage.dtype)
    for n in range(rows):
        u = raised(at(usage, n))
        for i in range(writers):
            head = (i + 1) * (3 * word + 3)
            put(used, i * rows + n, u)
            u += (1 - u) * at(heads, head - 2) * at(heads, head - 1) * (1 - u) * at(before, i * rows + n)
    for i in range(writers - 1, -1, -1):
        head = (i + 1) * (3 * word + 3)
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
        precede_back(used[i * rows : (i + 1) * rows], before[i * rows :], d_free, d_used)
    for n in range(rows):
        add(d_usage, n, (1 - EPSILON) * at(d_used, n))


@fused
def precede_back(used: Array, before: Array, d_free: Array, d_used: Array) -> None:
    """Back through (1 - used) * before: each usage is a factor for all rows after it; adds to `d_used`."""
    rows = len(used)
    shares = np.empty((rows, LANES), used.dtype)
    for n in range(rows):
        put(shares, n, at(d_free, n) * (1 - at(used, n)) * at(before, n))
    for n in range(rows):
        u, later = at(used, n), full(used, 0)
        for m in range(n):
            later += until(at(used, m), u, 0, at(shares, m))
        for m in range(n + 1, rows):
            later += until(u, at(used, m), at(shares, m), 0)
        add(d_used, n, later / u - at(d_free, n) * at(before, n))


@fused
def use_back(
    sizes: Sizes, heads: Array, old: AccessState[Array], d_usage: Array, d_heads: Array, d_before: Array,
    d_old_usage: Array,
) -> None:  # fmt: skip
    """Back through `use`, which takes past write weightings as given; adds to `d_before`."""
    word, rows, readers, writers, linked = sizes
    size = word + 2 * linked + 3
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
def activate_back(
    sizes: Sizes, write_heads: Array, read_heads: Array, d_write_heads: Array, d_read_heads: Array, d_interface: Array
) -> None:
    """Back through `activate`."""
    word, _, readers, writers, linked = sizes
    size = 3 * word + 3
    for i in range(writers):
        head, d_head = write_heads[i * size : (i + 1) * size], d_write_heads[i * size : (i + 1) * size]
        put(d_head, word, at(d_head, word) * (1 - decay(at(head, word))))
        for k in range(2 * word + 1, size):
            put(d_head, k, at(d_head, k) * at(head, k) * (1 - at(head, k)))
    size = word + 2 * linked + 3
    for j in range(readers):
        head, d_head = read_heads[j * size : (j + 1) * size], d_read_heads[j * size : (j + 1) * size]
        free, mean = at(head, word + 1), full(head, 0)
        put(d_head, word, at(d_head, word) * (1 - decay(at(head, word))))
        put(d_head, word + 1, at(d_head, word + 1) * free * (1 - free))
        for k in range(word + 2, size):
            mean += at(head, k) * at(d_head, k)
        for k in range(word + 2, size):
            put(d_head, k, at(head, k) * (at(d_head, k) - mean))
    unlay(d_write_heads, d_interface[:, : len(d_write_heads)])
    unlay(d_read_heads, d_interface[:, len(d_write_heads) :])


@kernel
def unlay(rows: Array, samples: Array) -> None:
    """Undo `lay`."""
    for lane in range(samples.shape[0]):
        for k in range(rows.shape[0]):
            samples[lane, k] = rows[k, lane]
