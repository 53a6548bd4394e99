"""The way back through all temporal links; the words are those of `fogbench.learned.dnc.all_links`."""

from typing import Any

from fogbench.learned.dnc.all_links import (
    FOUR,
    Four,
    follow_four,
    follow_four_alone,
    link_four,
    link_four_alone,
    link_rows,
    starts_of,
)
from fogbench.learned.dnc.job import Sizes
from fogbench.learned.kernels.instructions import at, full, put, total
from fogbench.learned.kernels.lane_arrays import add, clear, unfilled
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array


@fused
def link_all_back(
    sizes: Sizes, i: int, links: Array, w: Array, p: Array, modes: Array, size: int, before: Array, d_read: Array,
    d_new_links: Array, ahead: Array, back: Array, d_links: Array, d_w: Array, d_p: Array,
) -> None:  # fmt: skip
    """Back through all links of write head `i`; adds to `d_w` and `d_p`."""
    rows, linked, alone, pitch = sizes[1], sizes[4], sizes[5], link_rows(sizes)
    four, d_four = unfilled(FOUR * rows, d_read), unfilled(FOUR * rows, d_read)
    for n in range(0, pitch, FOUR):
        first, starts = (i * pitch + n) * rows, starts_of(n, pitch, rows)
        own, d_own = links[first:], d_links[first:] if len(d_links) else four[:, :LANES]  # which is read by then
        begin(d_new_links[first:], d_four[: min(FOUR, pitch - n) * rows])
        if alone:
            link_four_alone(n, own, w, p, four)
            follow_four_alone(n, four, starts, d_read, ahead, back, rows)
            ask_alone(n, modes, size, linked, before, d_read, d_four, rows)
            unlink_alone(n, own, starts, w, p, d_four, d_own, d_w, d_p)
        else:
            link_four(n, own, w, p, four)
            follow_four(n, four, starts, d_read, ahead, back, rows)
            ask(n, modes, size, linked, before, d_read, d_four, rows)
            unlink_four(n, own, starts, w, p, d_four, d_own, d_w, d_p)


@fused
def begin(d_new_links: Array, d_rows: Array) -> None:
    """What the next step asks of the links of some rows, if it asks."""
    if not len(d_new_links):
        clear(d_rows)
        return
    for m in range(len(d_rows)):
        put(d_rows, m, at(d_new_links, m))


@fused
def ask(n: int, modes: Array, size: int, linked: int, before: Array, d_read: Array, d_four: Array, rows: int) -> None:
    """Add what the read heads ask of the links of four rows from `n` on, but for those of a row to itself."""
    _, b, c, d = starts_of(n, rows, 1)
    for j in range(0, len(d_read), rows):
        x, y, mode = before[j + n :], d_read[j + n :], j // rows * size
        ago, onward = at(modes, mode), at(modes, mode + linked)
        backward = ago * at(x, 0), ago * at(x, b), ago * at(x, c), ago * at(x, d)
        forward = onward * at(y, 0), onward * at(y, b), onward * at(y, c), onward * at(y, d)
        along_back(backward, forward, before[j:], d_read[j:], d_four, rows)
    for k in range(FOUR):
        if n + k < rows:
            put(d_four, k * rows + n + k, full(d_four, 0))
        else:
            clear(d_four[k * rows : (k + 1) * rows])


@fused
def ask_alone(
    n: int, modes: Array, size: int, linked: int, before: Array, d_read: Array, d_four: Array, rows: int
) -> None:  # fmt: skip
    """The same of one sample."""
    k, lane = divmod(n, LANES)
    for j in range(0, len(d_read), rows):
        x, y, mode = before[j + k, lane:], d_read[j + k, lane:], j // rows * size
        ago, onward = at(modes, mode), at(modes, mode + linked)
        backward = ago * x[0], ago * x[1], ago * x[2], ago * x[3]
        forward = onward * y[0], onward * y[1], onward * y[2], onward * y[3]
        along_back(backward, forward, before[j:], d_read[j:], d_four, rows)
    for row in range(FOUR):
        d_four[row * rows + k, lane + row] = 0


@fused
def along_back(backward: Any, forward: Any, before: Array, d_read: Array, d_four: Array, rows: int) -> None:
    """Add what one read head asks of the links of four rows, which it follows so much backward and forward."""
    (back_a, back_b, back_c, back_d), (on_a, on_b, on_c, on_d) = backward, forward
    for m in range(rows):
        x, y = at(before, m), at(d_read, m)
        add(d_four, m, on_a * x + back_a * y)
        add(d_four, rows + m, on_b * x + back_b * y)
        add(d_four, 2 * rows + m, on_c * x + back_c * y)
        add(d_four, 3 * rows + m, on_d * x + back_d * y)


@fused
def unlink_four(
    n: int, links: Array, starts: Four, w: Array, p: Array, d_four: Array, d_links: Array, d_w: Array, d_p: Array
) -> None:  # fmt: skip
    """Back through the links of four rows from `n` on; adds to `d_w` and `d_p`."""
    _, b, c, d = starts_of(n, len(w), 1)
    own = w[n:]
    d_to = unlink(links, starts, (at(own, 0), at(own, b), at(own, c), at(own, d)), w, p, d_four, d_links, d_w, d_p)
    for k in range(min(FOUR, len(own))):
        add(d_w, n + k, d_to[k])


@fused
def unlink_alone(
    n: int, links: Array, starts: Four, w: Array, p: Array, d_four: Array, d_links: Array, d_w: Array, d_p: Array
) -> None:  # fmt: skip
    """The same of one sample."""
    k, lane = divmod(n, LANES)
    own = w[k, lane:]
    d_to = unlink(links, starts, (own[0], own[1], own[2], own[3]), w, p, d_four, d_links, d_w, d_p)
    for row in range(FOUR):
        d_w[k, lane + row] += total(d_to[row])


@fused
def unlink(
    links: Array, starts: Four, to: Any, w: Array, p: Array, d_four: Array, d_links: Array, d_w: Array, d_p: Array
) -> Any:  # fmt: skip
    """Back through `link_row` of four rows: the gradients by `to`; adds to `d_w` and `d_p`.

    `d_four` is zero for rows that are missing; so the last row, which stands for them, is written after them.
    """
    rows, (at_a, at_b, at_c, at_d), (to_a, to_b, to_c, to_d) = len(w), starts, to
    d_to_a = d_to_b = d_to_c = d_to_d = full(w, 0)
    for m in range(rows):
        kept, came = 1 - at(w, m), at(p, m)
        a, b, c, d = at(d_four, m), at(d_four, rows + m), at(d_four, 2 * rows + m), at(d_four, 3 * rows + m)
        lost_a, lost_b = a * at(links, at_a + m), b * at(links, at_b + m)
        lost_c, lost_d = c * at(links, at_c + m), d * at(links, at_d + m)
        put(d_links, at_d + m, (kept - to_d) * d)
        put(d_links, at_c + m, (kept - to_c) * c)
        put(d_links, at_b + m, (kept - to_b) * b)
        put(d_links, at_a + m, (kept - to_a) * a)
        add(d_w, m, 0 - (lost_a + lost_b + lost_c + lost_d))
        add(d_p, m, to_a * a + to_b * b + to_c * c + to_d * d)
        d_to_a += a * came - lost_a
        d_to_b += b * came - lost_b
        d_to_c += c * came - lost_c
        d_to_d += d * came - lost_d
    return d_to_a, d_to_b, d_to_c, d_to_d
