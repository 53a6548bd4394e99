"""Value iteration on a CPU: the function of `learned.value_iteration.plain` and its gradients, by loops of our own.

The term of the reward is computed once, an iteration is one pass over blocks of samples that stay in the cache, and
which action gave each value is kept for the way back.
"""

from typing import Any

import torch
from torch import Tensor
from torch.autograd.function import once_differentiable

from learned.threads import share
from learned.value_iteration_backward import backward_blocks
from learned.value_iteration_forward import forward_blocks
from learned.value_iteration_planes import plane_size
from worlds.types import Array

LANES = 16
"""Most samples of a block: 16 float32 are one cache line, and one AVX-512 register."""


def fast(reward: Tensor, weights: Tensor, iterations: int, barrier: Tensor | None = None) -> tuple[Tensor, Tensor]:
    """Q and V as `learned.value_iteration.plain` gives them, for float32 or float64 and four actions."""
    barrier = reward.new_empty(0, 4, *reward.shape[2:]) if barrier is None else barrier
    inputs = reward.contiguous(), barrier.contiguous(), weights.flatten(2).contiguous()
    if torch.is_grad_enabled() and any(x.requires_grad for x in inputs):
        q, v = _Fast.apply(*inputs, iterations)  # type: ignore[no-untyped-call]  # as PyTorch has it
    else:
        lanes = _lanes(len(reward))
        q, v = _forward(*inputs, iterations, lanes, *_history(reward, lanes, blocks=0, iterations=0))
    return q, v.squeeze(1)  # [B, 1, H, W] -> [B, H, W]


class _Fast(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, reward: Tensor, barrier: Tensor, taps: Tensor, iterations: int) -> tuple[Tensor, Tensor]:
        ctx.lanes = _lanes(len(reward))
        history = _history(reward, ctx.lanes, -(-len(reward) // ctx.lanes), iterations)
        ctx.save_for_backward(reward, barrier, taps, *history)
        return _forward(reward, barrier, taps, iterations, ctx.lanes, *history)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, dq: Tensor, dv: Tensor) -> tuple[Tensor, Tensor, Tensor, None]:
        reward, barrier, taps, values, choices = ctx.saved_tensors
        dreward, dbarrier = torch.empty_like(reward), torch.empty_like(barrier)
        dtaps = taps.new_zeros(len(values), *taps.shape)  # [blocks, 4, C + 1, 9]
        grads = dq.contiguous(), dv.contiguous(), dreward, dbarrier, dtaps
        arrays = _arrays(reward, taps, values, choices, *grads)
        share(lambda first, last: backward_blocks(first, last, ctx.lanes, *arrays), len(values))
        return dreward, dbarrier, dtaps.sum(0), None


def _forward(
    reward: Tensor, barrier: Tensor, taps: Tensor, iterations: int, lanes: int, values: Tensor, choices: Tensor
) -> tuple[Tensor, Tensor]:
    q = reward.new_empty(len(reward), 4, *reward.shape[2:])
    v = reward.new_empty(len(reward), 1, *reward.shape[2:])
    arrays = _arrays(reward, barrier, taps, values, choices, q, v)
    blocks = -(-len(reward) // lanes)
    share(lambda first, last: forward_blocks(first, last, lanes, iterations, *arrays), blocks)
    return q, v


def _lanes(batch: int) -> int:
    """Samples of a block, so that each thread has one."""
    return min(LANES, -(-batch // torch.get_num_threads()))


def _history(reward: Tensor, lanes: int, blocks: int, iterations: int) -> tuple[Tensor, Tensor]:
    """Room for what is kept of the iterations: values and choices [blocks, iterations, P]."""
    shape = blocks, iterations, plane_size(lanes, *reward.shape[2:])
    return reward.new_empty(shape), reward.new_empty(shape, dtype=torch.uint8)


def _arrays(*tensors: Tensor) -> tuple[Array, ...]:
    return tuple(tensor.detach().numpy() for tensor in tensors)
