"""The temporal links of a memory access: which row was written after which, and what is read along them; both ways.

The links are far larger than all else. So the way back passes over them once: it links a row again, follows it, and
leaves its gradient, all while that row is at hand. It takes two rows at a time, which share what they load.

Words used here
    ahead, back   [R * N], the links, and the transposed links, times a vector of rows for each read head
    w, p          [N], what one write head wrote, and the precedence before
"""

from typing import Any

import numpy as np

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.job import Sizes, head_size
from fogbench.learned.kernels.instructions import at, full, put
from fogbench.learned.kernels.lane_arrays import add, clear, zeros
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array


@fused
def link(linked: int, old: AccessState[Array], weights: Array, links: Array, precedence: Array) -> None:
    """Rows written now follow the rows written last."""
    rows = len(old.usage)
    for i in range(linked):
        w, p = weights[i * rows : (i + 1) * rows], old.precedence[i * rows : (i + 1) * rows]
        for n in range(rows):
            first = (i * rows + n) * rows
            link_row(old.links[first:], n, w, p, links[first:])
        kept = unwritten(w)
        for n in range(rows):
            put(precedence, i * rows + n, kept * at(p, n) + at(w, n))


@fused
def link_row(links: Array, n: int, w: Array, p: Array, new_links: Array) -> None:
    """The links of row `n`."""
    to = at(w, n)
    for m in range(len(w)):
        put(new_links, m, (1 - to - at(w, m)) * at(links, m) + to * at(p, m))
    put(new_links, n, full(links, 0))


@fused
def unwritten(w: Array) -> Any:
    """How much was not written."""
    kept = full(w, 1)
    for n in range(len(w)):
        kept -= at(w, n)
    return kept


@fused
def follow(sizes: Sizes, heads: Array, links: Array, before: Array, weights: Array) -> None:
    """Add what is read backward and forward along the links to the read weightings."""
    word, rows, readers, _, linked = sizes
    size = head_size(heads, readers)
    ahead, back = np.empty((readers * rows, LANES), before.dtype), np.empty((readers * rows, LANES), before.dtype)
    for i in range(linked):
        clear(back)
        for n in range(0, rows, 2):
            along(rows, links[(i * rows + n) * rows :], n, before, ahead, back)
        for j in range(readers):
            mode = j * size + word + 2 + i
            backward, forward = at(heads, mode), at(heads, mode + linked)
            for n in range(j * rows, (j + 1) * rows):
                add(weights, n, backward * at(back, n) + forward * at(ahead, n))


@fused
def along(rows: int, pair: Array, n: int, vectors: Array, ahead: Array, back: Array) -> None:
    """What the links of row `n` and the next, if there is one, give to `ahead`, and add to `back`."""
    last = min(n + 1, rows - 1)
    for j in range(0, len(vectors), rows):
        x, y = at(vectors, j + n), at(vectors, j + last)
        if last == n:
            y = full(vectors, 0)
        ahead_x, ahead_y = full(ahead, 0), full(ahead, 0)
        for m in range(rows):
            of_x, of_y, v = at(pair, m), at(pair, (last - n) * rows + m), at(vectors, j + m)
            ahead_x += of_x * v
            ahead_y += of_y * v
            put(back, j + m, at(back, j + m) + of_x * x + of_y * y)
        put(ahead, j + last, ahead_y)
        put(ahead, j + n, ahead_x)


@fused
def links_back(
    sizes: Sizes, heads: Array, old: AccessState[Array], weights: Array, d_read: Array, d_new: AccessState[Array],
    d_old: AccessState[Array], d_heads: Array, d_weights: Array,
) -> None:  # fmt: skip
    """Back through `follow` and `link`; adds to `d_weights`, and to `d_old` but for the links."""
    word, rows, readers, _, linked = sizes
    size, before = head_size(heads, readers), old.read_weights
    ahead, back, d_row = zeros(d_read), zeros(d_read), np.empty((rows, LANES), d_read.dtype)
    pair = np.empty((2 * rows, LANES), d_read.dtype)
    for i in range(linked):
        w, p = weights[i * rows : (i + 1) * rows], old.precedence[i * rows : (i + 1) * rows]
        d_w, d_p = d_weights[i * rows :], d_old.precedence[i * rows :]
        precedence_back(w, p, d_new.precedence[i * rows :], d_w, d_p)
        clear(back)
        for n in range(0, rows, 2):  # as `along` takes them
            for k in range(n, min(n + 2, rows)):
                link_row(old.links[(i * rows + k) * rows :], k, w, p, pair[(k - n) * rows :])
            along(rows, pair, n, d_read, ahead, back)
            for k in range(n, min(n + 2, rows)):
                first = (i * rows + k) * rows
                for m in range(rows):
                    put(d_row, m, at(d_new.links, first + m))
                for j in range(readers):
                    modes = heads[j * size + word + 2 + i :]
                    along_back(modes, linked, k, before[j * rows :], d_read[j * rows :], d_row)
                link_row_back(old.links[first:], k, w, p, d_row, d_old.links[first:], d_w, d_p)
        for j in range(readers):
            mode, first = j * size + word + 2 + i, j * rows
            modes_back(
                heads[mode:], linked, before[first : first + rows], ahead[first:], back[first:],
                d_heads[mode:], d_old.read_weights[first:],
            )  # fmt: skip


@fused
def modes_back(
    modes: Array, linked: int, before: Array, ahead: Array, back: Array, d_modes: Array, d_before: Array
) -> None:
    """Back to the modes of one read head and to what it read before; adds to that."""
    backward, forward = at(modes, 0), at(modes, linked)
    d_backward, d_forward = full(modes, 0), full(modes, 0)
    for n in range(len(before)):
        d_backward += at(before, n) * at(ahead, n)
        d_forward += at(before, n) * at(back, n)
        add(d_before, n, backward * at(ahead, n) + forward * at(back, n))
    put(d_modes, 0, d_backward)
    put(d_modes, linked, d_forward)


@fused
def along_back(modes: Array, linked: int, n: int, before: Array, d_read: Array, d_links: Array) -> None:
    """Add what one read head asks of the links of row `n`."""
    ago, onward = at(modes, 0) * at(before, n), at(modes, linked) * at(d_read, n)
    for m in range(len(d_links)):
        add(d_links, m, onward * at(before, m) + ago * at(d_read, m))


@fused
def link_row_back(
    links: Array, n: int, w: Array, p: Array, d_new_links: Array, d_links: Array, d_w: Array, d_p: Array
) -> None:
    """Back through the links of row `n`; adds to `d_w` and `d_p`."""
    put(d_new_links, n, full(w, 0))
    to, d_to = at(w, n), full(w, 0)
    for m in range(len(w)):
        d_link = at(d_new_links, m)
        lost = d_link * at(links, m)
        put(d_links, m, (1 - to - at(w, m)) * d_link)
        add(d_w, m, 0 - lost)
        add(d_p, m, to * d_link)
        d_to += d_link * at(p, m) - lost
    add(d_w, n, d_to)


@fused
def precedence_back(w: Array, p: Array, d_precedence: Array, d_w: Array, d_p: Array) -> None:
    """Back through the precedence after a write; adds to `d_w` and `d_p`."""
    kept, lost = unwritten(w), full(w, 0)
    for n in range(len(w)):
        lost += at(d_precedence, n) * at(p, n)
    for n in range(len(w)):
        add(d_p, n, kept * at(d_precedence, n))
        add(d_w, n, at(d_precedence, n) - lost)
