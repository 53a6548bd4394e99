"""The gradients of value iteration, in blocks of samples; the words are those of `fogbench.learned.kernels.planes`."""

from typing import Any

from fogbench.learned.kernels.native import Loop
from fogbench.learned.kernels.planes import at, clear, lent, neighbours, pack, plane_size, planes, plus, taps, unpack
from fogbench.learned.value_iteration.job import BACKWARD_JOB, history_of, maps_of, weights_of
from fogbench.worlds.kernel import fused, kernel, summing
from fogbench.worlds.types import Array


@kernel
def room(number: Any, job: Any) -> tuple[Array]:
    """A thread has nine planes."""
    return (planes(9, plane_size(job.lanes, job.height, job.width), number),)


@kernel
def backward(number: Any, job: Any, block: int, scratch: Array) -> None:
    """One block of a job."""
    scratch = lent(scratch)
    values, choices = history_of(number, block, job)
    backward_block(
        job.lanes, block * job.lanes,
        maps_of(number, job.reward, job.channels, job), weights_of(number, job.weights, 0, job),
        scratch, values, choices, maps_of(number, job.dq, 4, job), maps_of(number, job.dv, 1, job),
        maps_of(number, job.dreward, job.channels, job), maps_of(number, job.dbarrier, 4, job),
        weights_of(number, job.dweights, block, job),
    )  # fmt: skip


@kernel
def backward_block(
    lanes: int, sample: int, reward: Array, weights: Array, scratch: Array, values: Array, choices: Array,
    dq: Array, dv: Array, dreward: Array, dbarrier: Array, dweights: Array,
) -> None:  # fmt: skip
    """A value passes its gradient to the action that gave it, and to no other."""
    channels, height, width = reward.shape[1:]
    row = (width + 1) * lanes
    total, routed, plane = scratch[:4], scratch[4:8], scratch[8]  # gradients by the terms, by one Q, by one V
    scratch[:] = 0
    dweights[:] = 0
    pack(dv, 0, sample, plane, lanes)
    for action in range(4):
        pack(dq, action, sample, total[action], lanes)
    grads = total  # only the last Q is a result
    for k in range(len(choices) - 1, -1, -1):
        route(plane, choices[k], routed, total)
        if k:  # the value before the first is zero
            overlap(dweights[:, channels], grads, values[k - 1], row, lanes)
            gather(plane, weights[:, channels], grads, row, lanes)
            clear(plane, lanes, height, width)
        grads = routed
    for channel in range(channels):
        gather(plane, weights[:, channel], total, row, lanes)
        unpack(plane, dreward, channel, sample, lanes)
        plane[:] = 0
        pack(reward, channel, sample, plane, lanes)
        overlap(dweights[:, channel], total, plane, row, lanes)
    if len(dbarrier):
        for action in range(4):
            unpack(total[action], dbarrier, action, sample, lanes)


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
            out[j] = plus(out[j], w, at(views, j))


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


BACKWARD = Loop(backward, BACKWARD_JOB, room)
