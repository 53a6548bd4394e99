"""The way back through the temporal links; the words are those of `fogbench.learned.dnc.links`."""

from typing import Any

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.job import Sizes, head_size
from fogbench.learned.dnc.links import (
    follow_pair,
    follow_pair_alone,
    link_pair,
    link_pair_alone,
    link_rows,
    unwritten,
)
from fogbench.learned.dnc.strongest import link_strongest_back
from fogbench.learned.kernels.instructions import at, full, put, total
from fogbench.learned.kernels.lane_arrays import add, clear, over, unfilled
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array


@fused
def links_back(
    sizes: Sizes, heads: Array, old: AccessState[Array], weights: Array, d_read: Array, d_new: AccessState[Array],
    d_old: AccessState[Array], d_heads: Array, d_weights: Array,
) -> None:  # fmt: skip
    """Back through `link`; adds to `d_weights`, and to `d_old` but for the links.

    Where no gradient came by the new links, or nobody asks for that by the old ones, these have no rows.
    """
    word, rows, readers, _, linked, alone, strongest = sizes
    size, before = head_size(heads, readers), old.read_weights
    ahead, back = unfilled(readers * rows, d_read), unfilled(readers * rows, d_read)
    for i in range(linked):
        w, p = weights[i * rows : (i + 1) * rows], old.precedence[i * rows : (i + 1) * rows]
        d_w, d_p, modes = d_weights[i * rows :], d_old.precedence[i * rows :], heads[word + 2 + i :]
        precedence_back(w, p, d_new.precedence[i * rows :], d_w, d_p, alone)
        clear(ahead)
        clear(back)
        if strongest:
            own = 2 * strongest * rows
            d_links = d_old.links[i * own : (i + 1) * own]
            clear(d_links)
            link_strongest_back(
                old.links[i * own : (i + 1) * own], w, p, modes, size, linked, before, d_read, d_new.links[i * own :],
                alone, ahead, back, d_links, d_w, d_p,
            )  # fmt: skip
        else:
            link_all_back(sizes, i, old.links, w, p, modes, size, before, d_read, d_new.links, ahead, back,
                          d_old.links, d_w, d_p)  # fmt: skip
        for j in range(readers):
            mode, first = j * size + word + 2 + i, j * rows
            modes_back(
                heads[mode:], linked, before[first : first + rows], ahead[first:], back[first:],
                d_heads[mode:], d_old.read_weights[first:],
            )  # fmt: skip


@fused
def link_all_back(
    sizes: Sizes, i: int, links: Array, w: Array, p: Array, modes: Array, size: int, before: Array, d_read: Array,
    d_new_links: Array, ahead: Array, back: Array, d_links: Array, d_w: Array, d_p: Array,
) -> None:  # fmt: skip
    """Back through all links of write head `i`; adds to `d_w` and `d_p`."""
    rows, linked, alone, pitch = sizes[1], sizes[4], sizes[5], link_rows(sizes)
    pair, d_row = unfilled(2 * rows, d_read), unfilled(rows, d_read)
    for n in range(0, pitch, 2):
        own = links[(i * pitch + n) * rows :]
        if alone:
            link_pair_alone(n, own, w, p, pair)
            follow_pair_alone(n, pair, d_read, ahead, back, rows)
        else:
            link_pair(n, own, w, p, pair)
            follow_pair(n, pair, d_read, ahead, back, rows)
        for k in range(n, min(n + 2, pitch)):
            first = (i * pitch + k) * rows
            d_old_row = d_links[first:] if len(d_links) else d_row[:, :LANES]
            begin(d_new_links[first:], d_row)
            if alone:
                ask_alone(k, modes, size, linked, before, d_read, d_row)
                link_row_back_alone(k, links[first:], w, p, d_row, d_old_row, d_w, d_p)
            else:
                ask(k, modes, size, linked, before, d_read, d_row)
                link_row_back(k, links[first:], w, p, d_row, d_old_row, d_w, d_p)


@fused
def begin(d_new_links: Array, d_row: Array) -> None:
    """What the next step asks of the links of a row, if it asks."""
    if not len(d_new_links):
        clear(d_row)
        return
    for m in range(len(d_row)):
        put(d_row, m, at(d_new_links, m))


@fused
def ask(n: int, modes: Array, size: int, linked: int, before: Array, d_read: Array, d_row: Array) -> None:
    """Add what the read heads ask of the links of row `n`, but for that to itself."""
    rows = len(d_row)
    for j in range(0, len(d_read), rows):
        along_back(
            modes[j // rows * size :], linked, at(before, j + n), at(d_read, j + n), before[j:], d_read[j:], d_row
        )
    put(d_row, n, full(d_row, 0))


@fused
def ask_alone(n: int, modes: Array, size: int, linked: int, before: Array, d_read: Array, d_row: Array) -> None:
    """The same of one sample."""
    (k, lane), rows = divmod(n, LANES), len(d_row)
    for j in range(0, len(d_read), rows):
        x, y = before[j + k, lane], d_read[j + k, lane]
        along_back(modes[j // rows * size :], linked, x, y, before[j:], d_read[j:], d_row)
    d_row[k, lane] = 0


@fused
def along_back(modes: Array, linked: int, x: Any, y: Any, before: Array, d_read: Array, d_row: Array) -> None:
    """Add what one read head asks of the links of a row, where it read x before and is asked for y."""
    ago, onward = at(modes, 0) * x, at(modes, linked) * y
    for m in range(len(d_row)):
        add(d_row, m, onward * at(before, m) + ago * at(d_read, m))


@fused
def link_row_back(
    n: int, links: Array, w: Array, p: Array, d_row: Array, d_links: Array, d_w: Array, d_p: Array
) -> None:
    """Back through the links of row `n`; adds to `d_w` and `d_p`."""
    add(d_w, n, unlink(links, at(w, n), w, p, d_row, d_links, d_w, d_p))


@fused
def link_row_back_alone(
    n: int, links: Array, w: Array, p: Array, d_row: Array, d_links: Array, d_w: Array, d_p: Array
) -> None:
    """The same of one sample."""
    k, lane = divmod(n, LANES)
    d_w[k, lane] += total(unlink(links, w[k, lane], w, p, d_row, d_links, d_w, d_p))


@fused
def unlink(links: Array, to: Any, w: Array, p: Array, d_row: Array, d_links: Array, d_w: Array, d_p: Array) -> Any:
    """Back through `link_row`: the gradient by `to`; adds to `d_w` and `d_p`."""
    d_to = full(w, 0)
    for m in range(len(w)):
        d_link = at(d_row, m)
        lost = d_link * at(links, m)
        put(d_links, m, (1 - to - at(w, m)) * d_link)
        add(d_w, m, 0 - lost)
        add(d_p, m, to * d_link)
        d_to += d_link * at(p, m) - lost
    return d_to


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
def precedence_back(w: Array, p: Array, d_precedence: Array, d_w: Array, d_p: Array, alone: int) -> None:
    """Back through the precedence after a write; adds to `d_w` and `d_p`."""
    kept, lost = unwritten(w, alone), full(w, 0)
    for n in range(len(w)):
        lost += at(d_precedence, n) * at(p, n)
    lost = over(lost, w, alone)
    for n in range(len(w)):
        add(d_p, n, kept * at(d_precedence, n))
        add(d_w, n, at(d_precedence, n) - lost)
