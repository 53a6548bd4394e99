"""Value iteration on blocks of samples; the words are those of `fogbench.learned.kernels.planes`."""

from typing import Any

import numpy as np

from fogbench.learned.kernels.native import Loop
from fogbench.learned.kernels.planes import at, clear, lent, neighbours, pack, plane_size, planes, plus, taps, unpack
from fogbench.learned.value_iteration.job import FORWARD_JOB, history_of, maps_of, weights_of
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array


@kernel
def room(number: Any, job: Any) -> tuple[Array, Array]:
    """A thread has seven planes of numbers, and two of choices."""
    size = plane_size(job.lanes, job.height, job.width)
    return planes(7, size, number), np.empty((2, size), np.uint8)


@kernel
def forward(number: Any, job: Any, block: int, scratch: Array, choices: Array) -> None:
    """One block of a job."""
    scratch, choices = lent(scratch), lent(choices)
    values = scratch[5:]  # two that take turns, if none is to be kept
    if job.values:
        values, choices = history_of(number, block, job)
    forward_block(
        job.lanes, job.iterations, block * job.lanes,
        maps_of(number, job.reward, job.channels, job), weights_of(number, job.weights, 0, job),
        maps_of(number, job.barrier, 4, job), scratch, values, choices,
        maps_of(number, job.q, 4, job), maps_of(number, job.v, 1, job),
    )  # fmt: skip


@kernel
def forward_block(
    lanes: int, iterations: int, sample: int, reward: Array, weights: Array, barrier: Array,
    scratch: Array, values: Array, choices: Array, q: Array, v: Array,
) -> None:  # fmt: skip
    """Value iteration on the block of samples from `sample` on."""
    channels, height, width = reward.shape[1:]
    row = (width + 1) * lanes
    terms, plane = scratch[:4], scratch[4]  # of Q: what is the same in all iterations; of the reward
    scratch[:5] = 0
    if len(barrier):
        for action in range(4):
            pack(barrier, action, sample, terms[action], lanes)
    for channel in range(channels):
        pack(reward, channel, sample, plane, lanes)
        correlate(terms, weights[:, channel], plane, row, lanes)
    after = plane
    for k in range(iterations):
        before, turn = after, k % len(values)
        after, choice = values[turn], choices[turn]
        if 0 < k < iterations - 1:
            backup(terms, weights[:, channels], before, after, choice, row, lanes)
        else:  # the value before the first is zero, and the last Q is a result
            if k:
                correlate(terms, weights[:, channels], before, row, lanes)
            maximise(terms, after, choice, row + lanes)
        clear(after, lanes, height, width)
    for action in range(4):
        unpack(terms[action], q, action, sample, lanes)
    unpack(after, v, 0, sample, lanes)


@fused
def backup(terms: Array, weights: Array, before: Array, after: Array, choice: Array, row: int, lanes: int) -> None:
    """One iteration: the largest over the actions of `terms` and the kernel's sum over the values before."""
    start = row + lanes
    t0, t1, t2, t3 = terms[0][start:], terms[1][start:], terms[2][start:], terms[3][start:]
    w0, w1, w2, w3 = taps(weights[0]), taps(weights[1]), taps(weights[2]), taps(weights[3])
    views, v, a = neighbours(before, row, lanes), after[start:], choice[start:]
    for j in range(len(before) - 2 * start):
        x = at(views, j)
        v[j], a[j] = largest(plus(t0[j], w0, x), plus(t1[j], w1, x), plus(t2[j], w2, x), plus(t3[j], w3, x))


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
        t0[j] = plus(t0[j], w0, x)
        t1[j] = plus(t1[j], w1, x)
        t2[j] = plus(t2[j], w2, x)
        t3[j] = plus(t3[j], w3, x)


FORWARD = Loop(forward, FORWARD_JOB, room)
