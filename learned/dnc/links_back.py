"""The way back through the temporal links; the words are those of `fogbench.learned.dnc.links`."""

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.all_links_back import link_all_back
from fogbench.learned.dnc.job import Sizes, head_size
from fogbench.learned.dnc.links import unwritten
from fogbench.learned.dnc.strongest import link_strongest_back
from fogbench.learned.kernels.instructions import at, full, put
from fogbench.learned.kernels.lane_arrays import add, clear, over, unfilled
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
