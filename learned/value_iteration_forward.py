"""Value iteration over blocks of samples; the words are those of `learned.value_iteration_planes`."""

import numpy as np

from learned.value_iteration_planes import at, clear, dot, neighbours, pack, plane_size, planes, taps, unpack
from worlds.kernel import fused, kernel
from worlds.types import Array


@kernel
def forward_blocks(
    first: int,
    last: int,
    lanes: int,
    iterations: int,
    reward: Array,
    weights: Array,
    barrier: Array,
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
        reward: [B, C, H, W].
        weights: [4, C + 1, 9], the value's taps last.
        barrier: [B, 4, H, W] added to Q in every iteration, or [0, 4, H, W] for none.
        values: [blocks, iterations, P] for the value after each iteration, or empty if none is to be kept.
        choices: of that shape, uint8, for the action that gave each value.
        q: [B, 4, H, W] for the last Q.
        v: [B, H, W] for its maximum over the actions.
    """
    channels, height, width = reward.shape[1:]
    row = (width + 1) * lanes
    size = plane_size(lanes, height, width)
    scratch = planes(5, size, reward.dtype)
    terms, plane = scratch[:4], scratch[4]  # of Q: what is the same in all iterations; of the reward
    if not len(values):
        values, choices = planes(2, size, reward.dtype)[None], np.empty((1, 2, size), np.uint8)
    for block in range(first, last):
        sample, kept = block * lanes, block % len(values)
        scratch[:] = 0
        if barrier.size:
            for action in range(4):
                pack(barrier, action, sample, terms[action], lanes)
        for channel in range(channels):
            pack(reward, channel, sample, plane, lanes)
            correlate(terms, weights[:, channel], plane, row, lanes)
        after = plane
        for k in range(iterations):
            before, turn = after, k % values.shape[1]
            after, choice = values[kept, turn], choices[kept, turn]
            if 0 < k < iterations - 1:
                backup(terms, weights[:, channels], before, after, choice, row, lanes)
            else:  # the value before the first is zero, and the last Q is a result
                if k:
                    correlate(terms, weights[:, channels], before, row, lanes)
                maximise(terms, after, choice, row + lanes)
            clear(after, lanes, height, width)
        for action in range(4):
            unpack(terms[action], q, action, sample, lanes)
        unpack(after, v.reshape(len(v), 1, height, width), 0, sample, lanes)


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
