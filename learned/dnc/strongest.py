"""Temporal links of which each row keeps the strongest alone, both ways.

As in Rae et al. 2016, "Scaling Memory-Augmented Neural Networks with Sparse Reads and Writes".

A link from a row that had none can only lead to one of the rows written last. So a row's new links are among those that
it has and a few that are the same for all rows, and no row is compared with all others.

Words used here
    S             links of a row; the first S rows of `links` have how strong they are, the others where they lead
    lane          of the sample; of one that is alone memory rows are in lanes, see `spot`
    w, p, to      as in the file `links`
    latest        [2 * S + 1] rows of the largest precedences, in this order
"""

from typing import Any

import numpy as np

from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array


@kernel
def spot(row: int, lane: int, alone: int) -> tuple[int, int]:
    """Where the number of a memory row is in an array of rows."""
    return divmod(row, LANES) if alone else (row, lane)


@kernel
def lanes_of(alone: int) -> int:
    """How many samples a block has."""
    return 1 if alone else LANES


@fused
def link_strongest(
    links: Array, w: Array, p: Array, vectors: Array, alone: int, new_links: Array, ahead: Array, back: Array
) -> None:
    """Link all rows of one write head, and add what is read along its links to `ahead` and `back`.

    Args:
        links: [2 * S * N], those before.
        w, p: [N], what the head wrote, and the precedence before.
        vectors: [readers * N], a number of each row for each read head.
        alone: 0, or how many rows a sample has that is alone.
        new_links: [2 * S * N], to fill; the rows that only fill up lanes stay as they are.
        ahead, back: [readers * N].
    """
    values, columns, latest = room(links, w, alone)
    rows, strongest = len(w), len(values)
    for lane in range(lanes_of(alone)):
        find_latest(p, alone or rows, lane, alone, latest)
        for n in range(alone or rows):
            link_one(n, links, w, p, latest, lane, alone, values, columns)
            k, own = spot(n, lane, alone)
            for s in range(strongest):
                new_links[s * rows + k, own] = values[s]
                new_links[(strongest + s) * rows + k, own] = columns[s]
            follow_one(n, values, columns, vectors, rows, lane, alone, ahead, back)


@kernel
def room(links: Array, w: Array, alone: int) -> tuple[Array, Array, Array]:
    """Room for the links of a row and for `latest`."""
    rows, strongest = len(w), len(links) // (2 * len(w))
    latest = np.empty(min(2 * strongest + 1, alone or rows), np.int64)
    return np.empty(strongest, w.dtype), np.empty(strongest, np.int64), latest


@kernel
def find_latest(p: Array, count: int, lane: int, alone: int, latest: Array) -> None:
    """The rows of the largest precedences, of equal ones the first."""
    found = 0
    for m in range(count):
        x = p[spot(m, lane, alone)]
        place = found
        while place > 0 and x > p[spot(latest[place - 1], lane, alone)]:
            if place < len(latest):
                latest[place] = latest[place - 1]
            place -= 1
        if place < len(latest):
            latest[place] = m
            found = min(found + 1, len(latest))


@kernel
def column_of(links: Array, s: int, rows: int, k: int, lane: int, count: int) -> int:
    """Where link number `s` of a row leads; a lane without a sample may hold anything."""
    column = links[len(links) // 2 + s * rows + k, lane]
    return int(column) if 0 <= column < count else 0


@kernel
def held(links: Array, column: int, most: int, rows: int, k: int, lane: int, count: int) -> int:
    """Which of the first `most` links of a row leads to a column; -1: none."""
    for s in range(most):
        if column_of(links, s, rows, k, lane, count) == column:
            return s
    return -1


@fused
def link_one(
    n: int, links: Array, w: Array, p: Array, latest: Array, lane: int, alone: int, values: Array, columns: Array
) -> None:
    """The strongest links of row `n` after a write, in this order; of equal ones the first."""
    rows, strongest = len(w), len(values)
    count, (k, own), found = alone or rows, spot(n, lane, alone), 0
    to = w[k, own]
    for s in range(strongest):
        m, before = column_of(links, s, rows, k, own, count), links[s * rows + k, own]
        if before != 0 or held(links, m, s, rows, k, own, count) < 0:  # a blank row has the same one S times
            there = spot(m, lane, alone)
            link = (1 - to - w[there]) * before + to * p[there]
            found = enter(values, columns, found, link if m != n else 0 * link, m)
    for m in latest:
        link = to * p[spot(m, lane, alone)]
        if found == strongest and link < values[strongest - 1]:
            break
        if held(links, m, strongest, rows, k, own, count) < 0:
            found = enter(values, columns, found, link if m != n else 0 * link, m)


@kernel
def enter(values: Array, columns: Array, found: int, value: Any, column: int) -> int:
    """Put a link into its place among those found; how many they are then."""
    place = found
    while place > 0 and (value > values[place - 1] or (value == values[place - 1] and column < columns[place - 1])):
        if place < len(values):
            values[place], columns[place] = values[place - 1], columns[place - 1]
        place -= 1
    if place < len(values):
        values[place], columns[place] = value, column
        return min(found + 1, len(values))
    return found


@fused
def follow_one(
    n: int, values: Array, columns: Array, vectors: Array, rows: int, lane: int, alone: int, ahead: Array, back: Array
) -> None:
    """Add what the links of row `n` give to `ahead` there, and to `back` where they lead."""
    k, own = spot(n, lane, alone)
    for s in range(len(values)):
        row, other = spot(columns[s], lane, alone)
        for j in range(0, len(vectors), rows):
            ahead[j + k, own] += values[s] * vectors[j + row, other]
            back[j + row, other] += values[s] * vectors[j + k, own]


@fused
def link_strongest_back(
    links: Array, w: Array, p: Array, modes: Array, size: int, linked: int, before: Array, d_read: Array,
    d_new_links: Array, alone: int, ahead: Array, back: Array, d_links: Array, d_w: Array, d_p: Array,
) -> None:  # fmt: skip
    """Back through `link_strongest` of one write head.

    Args:
        links, w, p, alone: as there.
        modes: from the head's backward mode of the first read head on.
        size: numbers of a read head.
        linked: from a backward mode to its forward mode.
        before, d_read: [readers * N], what was read before, and the gradient by what is read now.
        d_new_links: [2 * S * N], or nothing.
        ahead, back: [readers * N], to which what is read along the new links is added, of `d_read`.
        d_links: [2 * S * N] of zeros to fill, or nothing.
        d_w, d_p: [N], to which is added.
    """
    values, columns, latest = room(links, w, alone)
    rows, strongest = len(w), len(values)
    for lane in range(lanes_of(alone)):
        find_latest(p, alone or rows, lane, alone, latest)
        for n in range(alone or rows):
            link_one(n, links, w, p, latest, lane, alone, values, columns)
            follow_one(n, values, columns, d_read, rows, lane, alone, ahead, back)
            k, own = spot(n, lane, alone)
            to, d_to = w[k, own], 0 * w[k, own]
            for s in range(strongest):
                m = columns[s]
                if m == n:
                    continue
                row, other = spot(m, lane, alone)
                d = d_new_links[s * rows + k, own] if len(d_new_links) else 0 * to
                for j in range(0, len(d_read), rows):
                    mode = j // rows * size
                    ago, onward = (
                        modes[mode, lane] * before[j + k, own],
                        modes[mode + linked, lane] * d_read[j + k, own],
                    )
                    d += onward * before[j + row, other] + ago * d_read[j + row, other]
                was = held(links, m, strongest, rows, k, own, alone or rows)
                lost = d * links[was * rows + k, own] if was >= 0 else 0 * d
                if was >= 0 and len(d_links):
                    d_links[was * rows + k, own] = (1 - to - w[row, other]) * d
                d_w[row, other] -= lost
                d_p[row, other] += to * d
                d_to += d * p[row, other] - lost
            d_w[k, own] += d_to
