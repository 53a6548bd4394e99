"""Value iteration on a CPU: the function of `learned.value_iteration.plain` and its gradients, by loops of our own.

The term of the reward is computed once, an iteration is one pass over blocks of samples that stay in the cache, and
which action gave each value is kept for the way back.
"""

from typing import Any

import numpy as np
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
    inputs = (reward, weights) if barrier is None else (reward, weights, barrier)
    if torch.is_grad_enabled() and any(x.requires_grad for x in inputs):
        q, v = _Fast.apply(iterations, *inputs)  # type: ignore[no-untyped-call]  # as PyTorch has it
        return q, v
    arrays = _arrays(*inputs)
    unkept = np.empty((0, 0, 0), arrays[0].dtype), np.empty((0, 0, 0), np.uint8)
    return _forward(iterations, _lanes(len(reward)), *arrays, *unkept)


class _Fast(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, iterations: int, *inputs: Tensor) -> tuple[Tensor, Tensor]:
        reward = inputs[0]
        ctx.lanes = _lanes(len(reward))
        kept = -(-len(reward) // ctx.lanes), iterations, plane_size(ctx.lanes, *reward.shape[2:])
        history = reward.new_empty(kept), reward.new_empty(kept, dtype=torch.uint8)
        ctx.save_for_backward(*history, *inputs)
        return _forward(iterations, ctx.lanes, *_arrays(*inputs), *(x.numpy() for x in history))

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, dq: Tensor, dv: Tensor) -> tuple[Tensor | None, ...]:
        values, choices, *inputs = ctx.saved_tensors
        reward, taps, barrier = _arrays(*inputs)
        dreward, dbarrier = np.empty_like(reward), np.empty_like(barrier)
        dtaps = np.zeros((len(values), *taps.shape), taps.dtype)  # [blocks, 4, C + 1, 9]
        grads = _array(dq), _array(dv), dreward, dbarrier, dtaps
        arrays = reward, taps, values.numpy(), choices.numpy(), *grads
        share(lambda first, last: backward_blocks(first, last, ctx.lanes, *arrays), len(values))
        found = dreward, dtaps.sum(0).reshape(inputs[1].shape), dbarrier
        return None, *(torch.from_numpy(x) for x in found[: len(inputs)])


def _forward(
    iterations: int, lanes: int, reward: Array, taps: Array, barrier: Array, values: Array, choices: Array
) -> tuple[Tensor, Tensor]:
    batch, _, height, width = reward.shape
    q, v = np.empty((batch, 4, height, width), reward.dtype), np.empty((batch, height, width), reward.dtype)
    arrays = reward, taps, barrier, values, choices, q, v
    share(lambda first, last: forward_blocks(first, last, lanes, iterations, *arrays), -(-batch // lanes))
    return torch.from_numpy(q), torch.from_numpy(v)


def _lanes(batch: int) -> int:
    """Samples of a block, so that each thread has one."""
    return min(LANES, -(-batch // torch.get_num_threads()))


def _arrays(reward: Tensor, weights: Tensor, barrier: Tensor | None = None) -> tuple[Array, Array, Array]:
    """The inputs as the loops want them; NumPy, as a call of PyTorch takes longer than some iterations."""
    maps, taps = _array(reward), _array(weights)
    walls = np.empty((0, 4, *maps.shape[2:]), maps.dtype) if barrier is None else _array(barrier)
    return maps, taps.reshape(*taps.shape[:2], 9), walls


def _array(tensor: Tensor) -> Array:
    return np.ascontiguousarray(tensor.numpy(force=True))
