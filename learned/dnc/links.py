"""The temporal links of a memory access: which row was written after which, and what is read along them.

Words used here
    ahead, back   [R * N], the links, and the transposed links, times a vector of rows for each read head
    w, p          [N], what one write head wrote, and the precedence before
"""

from typing import Any

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.all_links import link_all
from fogbench.learned.dnc.job import Sizes, head_size
from fogbench.learned.dnc.strongest import link_strongest
from fogbench.learned.kernels.instructions import at, full, put
from fogbench.learned.kernels.lane_arrays import add, clear, over, unfilled
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
    else:
        link_all(sizes, i, links, w, p, vectors, new_links, ahead, back)


@fused
def unwritten(w: Array, alone: int) -> Any:
    """How much was not written."""
    written = full(w, 0)
    for n in range(len(w)):
        written += at(w, n)
    return 1 - over(written, w, alone)
