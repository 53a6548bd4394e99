"""The temporal links of a memory access: which row was written after which, and what is read along them; both ways.

The links are far larger than all else. So each way passes over them once: it links a row, follows it, and leaves its
gradient, all while that row is at hand. It takes two rows at a time, which share what they load. What is done with a
row is the same whether sixteen samples lie side by side or the rows of one (`alone`); where a row begins is not.

Words used here
    ahead, back   [R * N], the links, and the transposed links, times a vector of rows for each read head
    w, p          [N], what one write head wrote, and the precedence before
    to            how much of a row was written: of sixteen samples, or a plain number
"""

from typing import Any

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.job import Sizes, head_size
from fogbench.learned.dnc.strongest import link_strongest
from fogbench.learned.kernels.instructions import at, full, put, total
from fogbench.learned.kernels.lane_arrays import add, clear, over, unfilled
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array


@fused
def link(sizes: Sizes, heads: Array, old: AccessState[Array], new: AccessState[Array]) -> None:
    """Rows written now follow the rows written last; add what is read along the links to the read weightings."""
    word, rows, readers, _, linked, alone, _ = sizes
    size = head_size(heads, readers)
    ahead, back = unfilled(readers * rows, old.read_weights), unfilled(readers * rows, old.read_weights)
    for i in range(linked):
        w, p = new.write_weights[i * rows : (i + 1) * rows], old.precedence[i * rows :]
        clear(ahead)
        clear(back)
        link_head(sizes, i, old.links, w, p, old.read_weights, new.links, ahead, back)
        kept = unwritten(w, alone)
        for n in range(rows):
            put(new.precedence, i * rows + n, kept * at(p, n) + at(w, n))
        for j in range(readers):
            mode = j * size + word + 2 + i
            backward, forward = at(heads, mode), at(heads, mode + linked)
            for n in range(j * rows, (j + 1) * rows):
                add(new.read_weights, n, backward * at(back, n) + forward * at(ahead, n))


@fused
def link_again(sizes: Sizes, old: AccessState[Array], new: AccessState[Array]) -> None:
    """The links of `new` alone."""
    rows, linked, none = sizes[1], sizes[4], old.read_weights[:0]
    for i in range(linked):
        w, p = new.write_weights[i * rows : (i + 1) * rows], old.precedence[i * rows :]
        link_head(sizes, i, old.links, w, p, none, new.links, none, none)


@fused
def link_head(
    sizes: Sizes, i: int, links: Array, w: Array, p: Array, vectors: Array, new_links: Array, ahead: Array, back: Array
) -> None:
    """Link the rows of write head `i`, and add what `vectors` give along them to `ahead` and `back`."""
    rows, alone, strongest = sizes[1], sizes[5], sizes[6]
    if strongest:
        own = 2 * strongest * rows
        some = links[i * own : (i + 1) * own]
        link_strongest(some, w, p, vectors, alone, new_links[i * own :], ahead, back)
        return
    pitch = link_rows(sizes)
    for n in range(0, pitch, 2):
        first = (i * pitch + n) * rows
        pair = new_links[first:]
        if alone:
            link_pair_alone(n, links[first:], w, p, pair)
            follow_pair_alone(n, pair, vectors, ahead, back, rows)
        else:
            link_pair(n, links[first:], w, p, pair)
            follow_pair(n, pair, vectors, ahead, back, rows)


@fused
def link_rows(sizes: Sizes) -> int:
    """How many rows of links a write head has."""
    return sizes[1] * LANES if sizes[5] else sizes[1]


@fused
def link_pair(n: int, links: Array, w: Array, p: Array, new_links: Array) -> None:
    """The links of row `n` and the next, if there is one."""
    rows = len(w)
    for k in range(n, min(n + 2, rows)):
        row = new_links[(k - n) * rows : (k - n + 1) * rows]
        link_row(links[(k - n) * rows :], at(w, k), w, p, row)
        put(row, k, full(row, 0))


@fused
def link_pair_alone(n: int, links: Array, w: Array, p: Array, new_links: Array) -> None:
    """The same of one sample."""
    (k, lane), rows = divmod(n, LANES), len(w)
    link_row(links, w[k, lane], w, p, new_links[:rows])
    link_row(links[rows:], w[k, lane + 1], w, p, new_links[rows : 2 * rows])
    new_links[k, lane] = new_links[rows + k, lane + 1] = 0


@fused
def link_row(links: Array, to: Any, w: Array, p: Array, new_links: Array) -> None:
    """The links of one row, as if it could follow itself."""
    for m in range(len(w)):
        put(new_links, m, (1 - to - at(w, m)) * at(links, m) + to * at(p, m))


@fused
def unwritten(w: Array, alone: int) -> Any:
    """How much was not written."""
    written = full(w, 0)
    for n in range(len(w)):
        written += at(w, n)
    return 1 - over(written, w, alone)


@fused
def follow_pair(n: int, pair: Array, vectors: Array, ahead: Array, back: Array, rows: int) -> None:
    """What the links of row `n` and the next, if there is one, give to `ahead`, and add to `back`."""
    last = min(n + 1, rows - 1)
    other = pair[(last - n) * rows :]
    for j in range(0, len(vectors), rows):
        x, y = at(vectors, j + n), at(vectors, j + last)
        if last == n:
            y = full(vectors, 0)
        of_one, of_other = follow(pair[:rows], other, vectors[j:], x, y, back[j:])
        put(ahead, j + last, of_other)
        put(ahead, j + n, of_one)


@fused
def follow_pair_alone(n: int, pair: Array, vectors: Array, ahead: Array, back: Array, rows: int) -> None:
    """The same of one sample."""
    for j in range(n // LANES, len(vectors), rows):
        own, lane = j - n // LANES, n % LANES
        of_one, of_other = follow(
            pair[:rows], pair[rows:], vectors[own:], vectors[j, lane], vectors[j, lane + 1], back[own:]
        )
        ahead[j, lane], ahead[j, lane + 1] = total(of_one), total(of_other)


@fused
def follow(one: Array, other: Array, vector: Array, x: Any, y: Any, back: Array) -> Any:
    """What the links of two rows give ahead; adds to `back` what they give where the vector has x and y."""
    of_one, of_other = full(back, 0), full(back, 0)
    for m in range(len(one)):
        p, q, v = at(one, m), at(other, m), at(vector, m)
        of_one += p * v
        of_other += q * v
        put(back, m, at(back, m) + p * x + q * y)
    return of_one, of_other
