"""Value iteration on a CPU: the function of `learned.value_iteration.plain` and its gradients, by loops of our own.

The term of the reward is computed once, an iteration is one pass over blocks of samples that stay in the cache, and
which action gave each value is kept for the way back.
"""

from typing import Any

import torch
from torch import Tensor
from torch.autograd.function import once_differentiable

from learned import value_iteration_kernels as kernels
from learned.threads import share
from worlds.types import Array

LANES = 16
"""Most samples of a block: 16 float32 are one cache line, and one AVX-512 register."""


def fast(reward: Tensor, weights: Tensor, iterations: int, barrier: Tensor | None = None) -> tuple[Tensor, Tensor]:
    """Q and V as `learned.value_iteration.plain` gives them, for float32 or float64 and four actions."""
    barrier = reward.new_empty(0, 4, *reward.shape[2:]) if barrier is None else barrier
    inputs = reward.contiguous(), weights.flatten(2).contiguous(), barrier.contiguous()
    if torch.is_grad_enabled() and any(x.requires_grad for x in inputs):
        q, v = _Fast.apply(*inputs, iterations)  # type: ignore[no-untyped-call]  # as PyTorch has it
        return q, v
    lanes = _lanes(len(reward))
    return _forward(*inputs, iterations, lanes, *_history(reward, 1, lanes))


class _Fast(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, reward: Tensor, taps: Tensor, barrier: Tensor, iterations: int) -> tuple[Tensor, Tensor]:
        ctx.lanes = _lanes(len(reward))
        values, choices = _history(reward, iterations, ctx.lanes)
        ctx.save_for_backward(reward, taps, barrier, values, choices)
        return _forward(reward, taps, barrier, iterations, ctx.lanes, values, choices)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, dq: Tensor, dv: Tensor) -> tuple[Tensor, Tensor, Tensor, None]:
        reward, taps, barrier, values, choices = ctx.saved_tensors
        dq, dv = dq.contiguous(), dv.contiguous()
        dreward, dbarrier = torch.empty_like(reward), torch.empty_like(barrier)
        dtaps = taps.new_zeros(len(values), *taps.shape)  # [blocks, 4, C + 1, 9]
        arrays = _arrays(reward, taps, values, choices, dq, dv, dreward, dbarrier, dtaps)

        def run(first: int, last: int) -> None:
            kernels.backward(first, last, ctx.lanes, reward.new_empty(9, values.shape[2]).numpy(), *arrays)

        share(run, len(values))
        return dreward, dtaps.sum(0), dbarrier, None


def _lanes(batch: int) -> int:
    """Samples of a block, so that each thread has one."""
    return min(LANES, -(-batch // torch.get_num_threads()))


def _history(reward: Tensor, depth: int, lanes: int) -> tuple[Tensor, Tensor]:
    """Room for `depth` iterations of all blocks: values [blocks, depth + 1, P] and choices [blocks, depth, P]."""
    batch, _, height, width = reward.shape
    blocks, plane = -(-batch // lanes), (height + 2) * (width + 1) * lanes + 2 * lanes
    return reward.new_empty(blocks, depth + 1, plane), reward.new_empty(blocks, depth, plane, dtype=torch.uint8)


def _forward(
    reward: Tensor, taps: Tensor, barrier: Tensor, iterations: int, lanes: int, values: Tensor, choices: Tensor
) -> tuple[Tensor, Tensor]:
    q = reward.new_empty(len(reward), 4, *reward.shape[2:])
    v = reward.new_empty(len(reward), *reward.shape[2:])
    arrays = _arrays(reward, barrier, taps, values, choices, q, v)

    def run(first: int, last: int) -> None:
        kernels.forward(first, last, lanes, iterations, reward.new_empty(5, values.shape[2]).numpy(), *arrays)

    share(run, len(values))
    return q, v


def _arrays(*tensors: Tensor) -> tuple[Array, ...]:
    return tuple(tensor.detach().numpy() for tensor in tensors)
