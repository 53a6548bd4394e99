"""Value iteration on a CPU: the function `plain` and its gradients, by loops of our own.

The term of the reward is computed once, an iteration is one pass over blocks of samples that stay in the cache, and
which action gave each value is kept for the way back.
"""

from typing import Any

import torch
from torch import Tensor
from torch.autograd.function import once_differentiable

from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.native import Loop
from fogbench.learned.kernels.planes import plane_size
from fogbench.learned.value_iteration.backward import BACKWARD
from fogbench.learned.value_iteration.forward import FORWARD


def fast(reward: Tensor, weights: Tensor, iterations: int, barrier: Tensor | None = None) -> tuple[Tensor, Tensor]:
    """Q and V as `plain` gives them, for float32 or float64 and four actions."""
    inputs = reward, weights, barrier
    if torch.is_grad_enabled() and any(x is not None and x.requires_grad for x in inputs):
        q, v = _Fast.apply(iterations, *inputs)  # type: ignore[no-untyped-call]  # as PyTorch has it
        return q, v
    return _forward(_lanes(reward), iterations, *map(_ready, inputs), None, None)


class _Fast(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, iterations: int, *inputs: Tensor | None) -> tuple[Tensor, Tensor]:
        reward, weights, barrier = map(_ready, inputs)
        lanes = _lanes(reward)
        kept = -(-len(reward) // lanes), iterations, plane_size(lanes, *reward.shape[2:])
        given = reward, weights, barrier, reward.new_empty(kept), reward.new_empty(kept, dtype=torch.uint8)
        ctx.lanes, ctx.iterations = lanes, iterations
        ctx.save_for_backward(*given)
        return _forward(lanes, iterations, *given)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, dq: Tensor, dv: Tensor) -> tuple[Tensor | None, ...]:
        reward, weights, barrier, values, choices = ctx.saved_tensors
        dreward, dbarrier = torch.empty_like(reward), None if barrier is None else torch.empty_like(barrier)
        parts = weights.new_empty(len(values), *weights.shape)
        down = dq.contiguous(), dv.contiguous()
        _run(BACKWARD, ctx.lanes, ctx.iterations, reward, weights, values, choices, *down, dreward, dbarrier, parts)
        return None, dreward, torch.from_numpy(parts.numpy().sum(0)), dbarrier


def _forward(lanes: int, iterations: int, reward: Tensor, *others: Tensor | None) -> tuple[Tensor, Tensor]:
    """Q and V by the weights, the barrier and room for the history."""
    batch, _, height, width = reward.shape
    q, v = reward.new_empty(batch, 4, height, width), reward.new_empty(batch, height, width)
    _run(FORWARD, lanes, iterations, reward, *others, q, v)
    return q, v


def _run(loop: Loop, lanes: int, iterations: int, reward: Tensor, *others: Tensor | None) -> None:
    """Run a loop on a job, of which these are the arrays in its order."""
    loop.run(reward.dtype, -(-len(reward) // lanes), (lanes, *reward.shape, iterations), (reward, *others))


def _lanes(reward: Tensor) -> int:
    """Samples of a block, so that each thread has one."""
    return min(LANES, -(-len(reward) // torch.get_num_threads()))


def _ready(tensor: Tensor | None) -> Any:
    return None if tensor is None else tensor.contiguous()
