"""The temporal links of a memory access, forward and back: which row was written after which, and reading along them.

The links are far larger than all else. So the way back passes over them once: it links a row again, follows it, and
leaves its gradient, all while that row is at hand.

Words used here
    ahead, back   [R * N], the links, and the transposed links, times a vector of rows for each read head
    w, p          [N], what one write head wrote, and the precedence before
"""

from typing import Any

import numpy as np

from learned.dnc_access import AccessState
from learned.dnc_job import Sizes
from learned.lane_arrays import add, clear, zeros
from learned.lanes import LANES, at, full, put
from worlds.kernel import fused
from worlds.types import Array


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
    size = word + 2 * linked + 3
    ahead, back = np.empty((readers * rows, LANES), before.dtype), np.empty((readers * rows, LANES), before.dtype)
    for i in range(linked):
        clear(back)
        for n in range(rows):
            along(rows, links[(i * rows + n) * rows :], n, before, ahead, back)
        for j in range(readers):
            mode = j * size + word + 2 + i
            backward, forward = at(heads, mode), at(heads, mode + linked)
            for n in range(j * rows, (j + 1) * rows):
                add(weights, n, backward * at(back, n) + forward * at(ahead, n))


@fused
def along(rows: int, links: Array, n: int, vectors: Array, ahead: Array, back: Array) -> None:
    """What the links of row `n` give to `ahead`, and add to `back`."""
    for j in range(0, len(vectors), rows):
        x, total = at(vectors, j + n), full(vectors, 0)
        for m in range(rows):
            total += at(links, m) * at(vectors, j + m)
            add(back, j + m, at(links, m) * x)
        put(ahead, j + n, total)


@fused
def links_back(
    sizes: Sizes, heads: Array, old: AccessState[Array], weights: Array, d_read: Array, d_new: AccessState[Array],
    d_old: AccessState[Array], d_heads: Array, d_weights: Array,
) -> None:  # fmt: skip
    """Back through `follow` and `link`; adds to `d_weights`, and to `d_old` but for the links."""
    word, rows, readers, _, linked = sizes
    size, before = word + 2 * linked + 3, old.read_weights
    ahead, back, row = zeros(d_read), zeros(d_read), np.empty((rows, LANES), d_read.dtype)
    for i in range(linked):
        w, p = weights[i * rows : (i + 1) * rows], old.precedence[i * rows : (i + 1) * rows]
        d_w, d_p = d_weights[i * rows :], d_old.precedence[i * rows :]
        precedence_back(w, p, d_new.precedence[i * rows :], d_w, d_p)
        clear(back)
        for n in range(rows):
            first = (i * rows + n) * rows
            link_row(old.links[first:], n, w, p, row)
            along(rows, row, n, d_read, ahead, back)
            for m in range(rows):
                put(row, m, at(d_new.links, first + m))
            for j in range(readers):
                modes = heads[j * size + word + 2 + i :]
                along_back(modes, linked, n, before[j * rows :], d_read[j * rows :], row)
            link_row_back(old.links[first:], n, w, p, row, d_old.links[first:], d_w, d_p)
        for j in range(readers):
            mode = j * size + word + 2 + i
            backward, forward = at(heads, mode), at(heads, mode + linked)
            d_backward, d_forward = full(heads, 0), full(heads, 0)
            for n in range(j * rows, (j + 1) * rows):
                d_backward += at(before, n) * at(ahead, n)
                d_forward += at(before, n) * at(back, n)
                add(d_old.read_weights, n, backward * at(ahead, n) + forward * at(back, n))
            put(d_heads, mode, d_backward)
            put(d_heads, mode + linked, d_forward)


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
