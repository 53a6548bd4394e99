"""All temporal links, and what is read along them.

They are far larger than all else. So each way passes over them once: it links a row, follows it, and leaves its
gradient, all while that row is at hand. It takes four rows at a time, which share what they load and whose sums do not
wait for each other. What is done with a row is the same whether sixteen samples lie side by side or the rows of one
(`alone`); where a row begins is not.

Words used here
    ahead, back, w, p   as in the file `links`
    to                  how much of a row was written: of sixteen samples, or a plain number
    a, b, c, d          what belongs to four rows; where fewer are left, the last stands for those that are missing
    starts              where the links of the four begin, beside those of the first
"""

from typing import Any

from fogbench.learned.dnc.job import Sizes
from fogbench.learned.kernels.instructions import at, full, put, total
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array

FOUR = 4
"""Rows that are taken together."""

Four = tuple[Any, Any, Any, Any]
"""Of each row one."""


@fused
def link_all(
    sizes: Sizes, i: int, links: Array, w: Array, p: Array, vectors: Array, new_links: Array, ahead: Array, back: Array
) -> None:
    """Link all rows of write head `i`, and add what `vectors` give along its links to `ahead` and `back`."""
    rows, alone, pitch = sizes[1], sizes[5], link_rows(sizes)
    for n in range(0, pitch, FOUR):
        first, starts = (i * pitch + n) * rows, starts_of(n, pitch, rows)
        four = new_links[first:]
        if alone:
            link_four_alone(n, links[first:], w, p, four)
            follow_four_alone(n, four, starts, vectors, ahead, back, rows)
        else:
            link_four(n, links[first:], w, p, four)
            follow_four(n, four, starts, vectors, ahead, back, rows)


@fused
def link_rows(sizes: Sizes) -> int:
    """How many rows of links a write head has."""
    return sizes[1] * LANES if sizes[5] else sizes[1]


@kernel
def starts_of(n: int, pitch: int, rows: int) -> Four:
    """Where the links of four rows begin, beside those of row `n`."""
    left = pitch - n - 1
    return 0, min(1, left) * rows, min(2, left) * rows, min(3, left) * rows


@fused
def link_four(n: int, links: Array, w: Array, p: Array, new_links: Array) -> None:
    """The links of four rows from `n` on, or of as many as are left."""
    rows = len(w)
    for k in range(n, min(n + FOUR, rows)):
        row = new_links[(k - n) * rows : (k - n + 1) * rows]
        link_row(links[(k - n) * rows :], at(w, k), w, p, row)
        put(row, k, full(row, 0))


@fused
def link_four_alone(n: int, links: Array, w: Array, p: Array, new_links: Array) -> None:
    """The same of one sample."""
    (k, lane), rows = divmod(n, LANES), len(w)
    for own in range(FOUR):
        row = new_links[own * rows : (own + 1) * rows]
        link_row(links[own * rows :], w[k, lane + own], w, p, row)
        row[k, lane + own] = 0


@fused
def link_row(links: Array, to: Any, w: Array, p: Array, new_links: Array) -> None:
    """The links of one row, as if it could follow itself."""
    for m in range(len(w)):
        put(new_links, m, (1 - to - at(w, m)) * at(links, m) + to * at(p, m))


@fused
def follow_four(
    n: int, four: Array, starts: Four, vectors: Array, ahead: Array, back: Array, rows: int
) -> None:  # fmt: skip
    """What the links of four rows give to `ahead`, and add to `back`."""
    for j in range(0, len(vectors), rows):
        none, own = full(vectors, 0), vectors[j + n : j + rows]
        a, b = at(own, 0), at(own, 1) if len(own) > 1 else none
        c, d = at(own, 2) if len(own) > 2 else none, at(own, 3) if len(own) > 3 else none
        of_rows = follow(four, starts, rows, vectors[j:], (a, b, c, d), back[j:])
        for k in range(min(FOUR, len(own))):
            put(ahead, j + n + k, of_rows[k])


@fused
def follow_four_alone(n: int, four: Array, starts: Four, vectors: Array, ahead: Array, back: Array, rows: int) -> None:
    """The same of one sample."""
    k, lane = divmod(n, LANES)
    for j in range(0, len(vectors), rows):
        own = vectors[j + k, lane : lane + FOUR]
        of_rows = follow(four, starts, rows, vectors[j:], (own[0], own[1], own[2], own[3]), back[j:])
        for row in range(FOUR):
            ahead[j + k, lane + row] = total(of_rows[row])


@fused
def follow(links: Array, starts: Four, rows: int, vector: Array, there: Any, back: Array) -> Any:
    """What the links of four rows give ahead; adds to `back` what they give where the vector is what it is there."""
    (a, b, c, d), (at_a, at_b, at_c, at_d) = there, starts
    of_a = of_b = of_c = of_d = full(back, 0)
    for m in range(rows):
        p, q, r, s = at(links, at_a + m), at(links, at_b + m), at(links, at_c + m), at(links, at_d + m)
        v = at(vector, m)
        of_a += p * v
        of_b += q * v
        of_c += r * v
        of_d += s * v
        put(back, m, at(back, m) + (p * a + q * b) + (r * c + s * d))
    return of_a, of_b, of_c, of_d
