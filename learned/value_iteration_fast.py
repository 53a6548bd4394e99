"""Value iteration on a CPU: the function of `learned.value_iteration.plain` and its gradients, by loops of our own.

The term of the reward is computed once, an iteration is one pass over blocks of samples that stay in the cache, and
which action gave each value is kept for the way back.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import torch
from torch import Tensor
from torch.autograd.function import once_differentiable

from learned import value_iteration_kernels as kernels

LANES = 16
"""Most samples of a block: 16 float32 are one cache line, and one AVX-512 register."""


def fast(reward: Tensor, weights: Tensor, iterations: int, barrier: Tensor | None = None) -> tuple[Tensor, Tensor]:
    """Q and V as `learned.value_iteration.plain` gives them, for float32 or float64 and four actions."""
    barrier = reward.new_empty(0, *weights.shape[:1], *reward.shape[2:]) if barrier is None else barrier
    keep = torch.is_grad_enabled() and any(x.requires_grad for x in (reward, weights, barrier))
    q, v = _Fast.apply(reward, weights, barrier, iterations, keep)  # type: ignore[no-untyped-call]
    return q, v


class _Fast(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, reward: Tensor, weights: Tensor, barrier: Tensor, iterations: int, keep: bool) -> Any:
        reward, taps, barrier = reward.contiguous(), weights.flatten(2).contiguous(), barrier.contiguous()
        batch, _, height, width = reward.shape
        lanes = min(LANES, -(-batch // torch.get_num_threads()))
        blocks, plane = -(-batch // lanes), (height + 2) * (width + 1) * lanes + 2 * lanes
        values = reward.new_empty(blocks, iterations + 1 if keep else 2, plane)
        choices = torch.empty(blocks, iterations if keep else 1, plane, dtype=torch.uint8)
        q, v = reward.new_empty(batch, 4, height, width), reward.new_empty(batch, height, width)

        def task(block: slice, s: slice) -> None:
            given = reward[s], barrier[s], taps, lanes, iterations
            scratch = reward.new_empty(5, plane)
            kernels.forward(*map(_np, (*given, values[block], choices[block], scratch, q[s], v[s])))

        _in_threads(task, blocks, lanes)
        ctx.save_for_backward(reward, taps, barrier, values, choices)
        ctx.lanes, ctx.shape = lanes, weights.shape
        return q, v

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, dq: Tensor, dv: Tensor) -> Any:
        reward, taps, barrier, values, choices = ctx.saved_tensors
        dq, dv = dq.contiguous(), dv.contiguous()
        dreward, dbarrier = torch.empty_like(reward), torch.empty_like(barrier)
        dtaps = taps.new_zeros(len(values), *taps.shape)  # [blocks, 4, C + 1, 9]

        def task(block: slice, s: slice) -> None:
            given = reward[s], taps, ctx.lanes, values[block], choices[block]
            scratch = reward.new_empty(9, values.shape[2])
            kernels.backward(*map(_np, (*given, scratch, dq[s], dv[s], dreward[s], dbarrier[s], dtaps[block])))

        _in_threads(task, len(values), ctx.lanes)
        return dreward, dtaps.sum(0).view(ctx.shape), dbarrier, None, None


def _np(x: Any) -> Any:
    return x.detach().numpy() if isinstance(x, Tensor) else x


def _in_threads(task: Callable[[slice, slice], None], blocks: int, lanes: int) -> None:
    """Run `task` on as many ranges of blocks, and of their samples, as PyTorch has threads."""
    threads = min(blocks, torch.get_num_threads())
    bounds = [blocks * i // threads for i in range(threads + 1)]
    ranges = [slice(*pair) for pair in zip(bounds, bounds[1:])]
    samples = [slice(r.start * lanes, r.stop * lanes) for r in ranges]
    if threads == 1:
        task(ranges[0], samples[0])
        return
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(task, ranges, samples))
