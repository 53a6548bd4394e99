"""Rows in the order of their numbers, each lane for itself: a sorting network takes all lanes through the same steps.

The network is Batcher's merge exchange (Knuth, The Art of Computer Programming, vol. 3, 5.2.2, algorithm M): for N rows
some N * (log2 N)^2 / 4 exchanges, whatever the numbers are.
"""

from fogbench.learned.kernels.instructions import at, full, put, until
from fogbench.learned.kernels.lane_arrays import same, unfilled
from fogbench.learned.kernels.lanes import LANES
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array


@fused
def ordered(rows: Array) -> tuple[Array, Array]:
    """The numbers of each lane in their order, [N, 16], and from which row each came; of equals the first is first."""
    numbers, order = same(rows), unfilled(len(rows), rows)
    for n in range(len(rows)):
        put(order, n, full(rows, n))
    first = 1
    while 2 * first < len(rows):
        first *= 2
    p = first
    while p > 0:
        q, r, d = first, 0, p
        while True:
            for n in range(len(rows) - d):
                if n & p == r:
                    exchange(numbers, order, n, n + d)
            if q == p:
                break
            q, r, d = q // 2, p, q - p
        p //= 2
    return numbers, order


@fused
def exchange(numbers: Array, order: Array, n: int, m: int) -> None:
    """Put two rows into their order."""
    x, y, i, j = at(numbers, n), at(numbers, m), at(order, n), at(order, m)
    wrong = until(x, y, until(y, x, until(i, j, 0, 1), 0), 1)
    put(numbers, n, until(wrong, 0, x, y))
    put(numbers, m, until(wrong, 0, y, x))
    put(order, n, until(wrong, 0, i, j))
    put(order, m, until(wrong, 0, j, i))


@kernel
def gather(rows: Array, order: Array, chosen: Array) -> None:
    """The rows in an order."""
    for k in range(len(order)):
        for lane in range(LANES):
            chosen[k, lane] = rows[int(order[k, lane]), lane]


@kernel
def scatter(chosen: Array, order: Array, rows: Array) -> None:
    """Undo `gather`."""
    for k in range(len(order)):
        for lane in range(LANES):
            rows[int(order[k, lane]), lane] = chosen[k, lane]
