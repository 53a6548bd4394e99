"""The loops of value iteration over blocks of samples, forward and backward.

Words used here
    L, C     samples of a block, laid side by side: its lanes;  channels of the reward map
    plane    [P] one channel of a block, flat: zeros, then H rows of W cells and one zero cell, then zeros. A cell is L
             numbers, one of each sample. The zero cell that ends a row also stands before the next, so the nine
             neighbours of all cells are nine shifted views of the plane
    row      (W + 1) * L, the numbers of a row;  P = H * row + 2 * (row + L)
    taps     the nine weights of a 3x3 kernel, row by row

A neighbour is only a shift, so one loop serves any L: with 16 each load of float32 is one cache line, and with 1 it
runs along the rows of a single map.
"""

import numpy as np

from worlds.kernel import fused, kernel, summing
from worlds.types import Array


@kernel
def forward(
    first: int,
    last: int,
    lanes: int,
    iterations: int,
    scratch: Array,
    reward: Array,
    barrier: Array,
    weights: Array,
    values: Array,
    choices: Array,
    q: Array,
    v: Array,
) -> None:
    """Value iteration on some blocks.

    Args:
        first, last: the blocks, without the last.
        lanes: samples of a block; the last of all blocks may have fewer.
        iterations: at least 1.
        scratch: [5, P].
        reward: [B, C, H, W].
        barrier: [B, 4, H, W] added to Q in every iteration, or [0, 4, H, W] for none.
        weights: [4, C + 1, 9], the value's taps last.
        values: [blocks, iterations + 1, P] for the value before and after each iteration, or 2 that take turns.
        choices: [blocks, iterations, P] uint8 for the action that gave each value, or 1.
        q: [B, 4, H, W] for the last Q.
        v: [B, H, W] for its maximum over the actions.
    """
    for block in range(first, last):
        s = slice(block * lanes, (block + 1) * lanes)
        _forward(iterations, reward[s], barrier[s], weights, values[block], choices[block], q[s], v[s], scratch)


@kernel
def _forward(
    iterations: int,
    reward: Array,
    barrier: Array,
    weights: Array,
    values: Array,
    choices: Array,
    q: Array,
    v: Array,
    scratch: Array,
) -> None:
    lanes, channels, height, width = reward.shape
    row = (width + 1) * lanes
    size = (height + 2) * row + 2 * lanes
    scratch[:] = 0
    terms, plane = scratch[:4], scratch[4][:size]  # of Q: what is the same in all iterations; of the reward
    if barrier.size:
        for action in range(4):
            pack(barrier[:, action], terms[action])
    for channel in range(channels):
        pack(reward[:, channel], plane)
        correlate(terms, weights[:, channel], plane, row, lanes)
    before, after, choice = plane, values[0][:size], choices[0][:size]
    after[:] = 0
    for k in range(iterations):
        before, after = after, values[(k + 1) % len(values)][:size]
        choice = choices[k % len(choices)][:size]
        if k < iterations - 1:
            backup(terms, weights[:, channels], before, after, choice, row, lanes)
            clear(after, lanes, height, width)
    correlate(terms, weights[:, channels], before, row, lanes)
    maximise(terms, after, choice, row + lanes)
    for action in range(4):
        unpack(terms[action], q[:, action])
    unpack(after, v)


@kernel
def backward(
    first: int,
    last: int,
    lanes: int,
    scratch: Array,
    reward: Array,
    weights: Array,
    values: Array,
    choices: Array,
    dq: Array,
    dv: Array,
    dreward: Array,
    dbarrier: Array,
    dweights: Array,
) -> None:
    """Gradients of `forward` on some blocks: a value passes its own to the action that gave it, and to no other.

    Args:
        first, last, lanes, reward, weights, values, choices: as in `forward`, with the values of all iterations.
        scratch: [9, P].
        dq, dv: gradients by the results.
        dreward, dbarrier: shaped as `reward` and `barrier`, for the gradients by them.
        dweights: [blocks, 4, C + 1, 9] zeros, for each block's part of the gradient by the weights.
    """
    for block in range(first, last):
        s = slice(block * lanes, (block + 1) * lanes)
        _backward(
            reward[s],
            weights,
            values[block],
            choices[block],
            dq[s],
            dv[s],
            dreward[s],
            dbarrier[s],
            dweights[block],
            scratch,
        )


@kernel
def _backward(
    reward: Array,
    weights: Array,
    values: Array,
    choices: Array,
    dq: Array,
    dv: Array,
    dreward: Array,
    dbarrier: Array,
    dweights: Array,
    scratch: Array,
) -> None:
    lanes, channels, height, width = reward.shape
    row = (width + 1) * lanes
    size = (height + 2) * row + 2 * lanes
    scratch[:] = 0
    total, routed, plane = scratch[:4], scratch[4:8], scratch[8][:size]  # gradients by terms, by one Q, by one V
    pack(dv, plane)
    for action in range(4):
        pack(dq[:, action], total[action])
    iterations = len(choices)
    for k in range(iterations - 1, -1, -1):
        route(plane, choices[k], routed, total)
        grads = total if k == iterations - 1 else routed  # only the last Q is a result
        overlap(dweights[:, channels], grads, values[k][:size], row, lanes)
        gather(plane, weights[:, channels], grads, row, lanes)
        clear(plane, lanes, height, width)
    for channel in range(channels):
        gather(plane, weights[:, channel], total, row, lanes)
        unpack(plane, dreward[:, channel])
        plane[:] = 0
        pack(reward[:, channel], plane)
        overlap(dweights[:, channel], total, plane, row, lanes)
    if dbarrier.size:
        for action in range(4):
            unpack(total[action], dbarrier[:, action])


@kernel
def pack(maps: Array, plane: Array) -> None:
    """Lay maps [L, H, W] side by side into a plane."""
    lanes, height, width = maps.shape
    cells = cells_of(plane, lanes, height, width)
    for lane in range(lanes):
        for y in range(height):
            for x in range(width):
                cells[y + 1, x + 1, lane] = maps[lane, y, x]


@kernel
def unpack(plane: Array, maps: Array) -> None:
    """Undo `pack`."""
    lanes, height, width = maps.shape
    cells = cells_of(plane, lanes, height, width)
    for lane in range(lanes):
        for y in range(height):
            for x in range(width):
                maps[lane, y, x] = cells[y + 1, x + 1, lane]


@kernel
def clear(plane: Array, lanes: int, height: int, width: int) -> None:
    """Set to zero all that is no cell of a map."""
    cells = cells_of(plane, lanes, height, width)
    cells[0] = 0
    cells[1:, 0] = 0
    cells[height + 1] = 0
    plane[len(plane) - 2 * lanes :] = 0


@kernel
def cells_of(plane: Array, lanes: int, height: int, width: int) -> Array:
    """[H + 2, W + 1, L] a plane as rows of cells, cell (y, x) of the maps at (y + 1, x + 1)."""
    return plane[: (height + 2) * (width + 1) * lanes].reshape((height + 2, width + 1, lanes))


@fused
def backup(terms: Array, weights: Array, before: Array, after: Array, choice: Array, row: int, lanes: int) -> None:
    """One iteration: the largest over the actions of `terms` and the kernel's sum over the values before."""
    start = row + lanes
    t0, t1, t2, t3 = terms[0][start:], terms[1][start:], terms[2][start:], terms[3][start:]
    w0, w1, w2, w3 = taps(weights[0]), taps(weights[1]), taps(weights[2]), taps(weights[3])
    views, v, a = neighbours(before, row, lanes), after[start:], choice[start:]
    for j in range(len(before) - 2 * start):
        x = at(views, j)
        v[j], a[j] = largest(t0[j] + dot(w0, x), t1[j] + dot(w1, x), t2[j] + dot(w2, x), t3[j] + dot(w3, x))


@kernel
def maximise(terms: Array, after: Array, choice: Array, start: int) -> None:
    """The largest over the actions, and which it was."""
    t0, t1, t2, t3 = terms[0][start:], terms[1][start:], terms[2][start:], terms[3][start:]
    v, a = after[start:], choice[start:]
    for j in range(len(after) - 2 * start):
        v[j], a[j] = largest(t0[j], t1[j], t2[j], t3[j])


@kernel
def largest(q0: float, q1: float, q2: float, q3: float) -> tuple[float, int]:
    """The largest and its action, of equals the first; NaN counts as larger than any number, as it does in PyTorch."""
    q, action = q0, 0
    if (q1 > q) | np.isnan(q1):
        q, action = q1, 1
    if (q2 > q) | np.isnan(q2):
        q, action = q2, 2
    if (q3 > q) | np.isnan(q3):
        q, action = q3, 3
    return q, action


@fused
def correlate(terms: Array, weights: Array, plane: Array, row: int, lanes: int) -> None:
    """Add to each action's plane its kernel's sum over the neighbours in `plane`."""
    start = row + lanes
    t0, t1, t2, t3 = terms[0][start:], terms[1][start:], terms[2][start:], terms[3][start:]
    w0, w1, w2, w3 = taps(weights[0]), taps(weights[1]), taps(weights[2]), taps(weights[3])
    views = neighbours(plane, row, lanes)
    for j in range(len(plane) - 2 * start):
        x = at(views, j)
        t0[j] += dot(w0, x)
        t1[j] += dot(w1, x)
        t2[j] += dot(w2, x)
        t3[j] += dot(w3, x)


@kernel
def route(plane: Array, choice: Array, routed: Array, total: Array) -> None:
    """Give each gradient to the action that was chosen, the others get zero; add that to the total."""
    zero = plane.dtype.type(0)
    for action in range(4):
        here, sums = routed[action], total[action]
        for j in range(len(plane)):
            here[j] = plane[j] if choice[j] == action else zero
            sums[j] += here[j]


@fused
def gather(plane: Array, weights: Array, grads: Array, row: int, lanes: int) -> None:
    """The transpose of `correlate`: what each cell gets back from the actions in whose sums it was."""
    start = row + lanes
    out = plane[start:]
    out[:] = 0
    for action in range(4):
        w = taps(weights[action][::-1])
        views = neighbours(grads[action], row, lanes)
        for j in range(len(plane) - 2 * start):
            out[j] += dot(w, at(views, j))


@kernel
def overlap(sums: Array, grads: Array, plane: Array, row: int, lanes: int) -> None:
    """Add to `sums` [4, 9] the gradient by each tap: an action's gradients times the neighbours in `plane`, summed."""
    start, end = row + lanes, len(plane) - row - lanes
    g0, g1, g2, g3 = grads[0][start:end], grads[1][start:end], grads[2][start:end], grads[3][start:end]
    for y in range(3):
        x = plane[y * row :]
        products = twelve(g0, g1, g2, g3, x, x[lanes:], x[2 * lanes :])
        for action in range(4):
            for i in range(3):
                sums[action, 3 * y + i] += products[action][i]


@summing
def twelve(
    g0: Array, g1: Array, g2: Array, g3: Array, x0: Array, x1: Array, x2: Array
) -> tuple[tuple[float, ...], ...]:
    """The scalar products of each g with each x; as many at once as share their loads and stay in registers."""
    a0 = a1 = a2 = b0 = b1 = b2 = c0 = c1 = c2 = d0 = d1 = d2 = x0.dtype.type(0)
    for j in range(len(g0)):
        x, y, z = x0[j], x1[j], x2[j]
        g = g0[j]
        a0, a1, a2 = a0 + g * x, a1 + g * y, a2 + g * z
        g = g1[j]
        b0, b1, b2 = b0 + g * x, b1 + g * y, b2 + g * z
        g = g2[j]
        c0, c1, c2 = c0 + g * x, c1 + g * y, c2 + g * z
        g = g3[j]
        d0, d1, d2 = d0 + g * x, d1 + g * y, d2 + g * z
    return (a0, a1, a2), (b0, b1, b2), (c0, c1, c2), (d0, d1, d2)


@kernel
def neighbours(plane: Array, row: int, lanes: int) -> tuple[Array, ...]:
    """Nine views of a plane; number j of each is the same cell's neighbour in that direction."""
    top, middle, bottom = plane, plane[row:], plane[2 * row :]
    return (
        top, top[lanes:], top[2 * lanes :],
        middle, middle[lanes:], middle[2 * lanes :],
        bottom, bottom[lanes:], bottom[2 * lanes :],
    )  # fmt: skip


@kernel
def at(x: tuple[Array, ...], j: int) -> tuple[float, ...]:
    """Number j of nine views."""
    return x[0][j], x[1][j], x[2][j], x[3][j], x[4][j], x[5][j], x[6][j], x[7][j], x[8][j]


@kernel
def taps(w: Array) -> tuple[float, ...]:
    """Nine weights, in registers."""
    return w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7], w[8]


@fused
def dot(w: tuple[float, ...], x: tuple[float, ...]) -> float:
    """The sum of nine products."""
    return (
        w[0] * x[0] + w[1] * x[1] + w[2] * x[2]
        + w[3] * x[3] + w[4] * x[4] + w[5] * x[5]
        + w[6] * x[6] + w[7] * x[7] + w[8] * x[8]
    )  # fmt: skip
