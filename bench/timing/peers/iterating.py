"""Value iteration beside the loop of public VIN code, on two threads, by the wall clock.

Before anything is timed, both must come to the same values.
"""

from collections.abc import Callable, Iterator

import torch
from torch import Tensor
from torch.nn.functional import conv2d
from turns import Turns, elapsed, milliseconds

from fogbench.learned.value_iteration.fast import fast

THREADS = 2
SHAPES = [(128, 16, 20), (32, 32, 40), (8, 64, 80), (512, 11, 16)]
"""Batch, rows and columns of a map, iterations."""

Form = Callable[[Tensor, Tensor, int], tuple[Tensor, Tensor]]
Inputs = tuple[Tensor, Tensor, int]
Work = Callable[[], tuple[Tensor, ...]]


def iterations() -> Iterator[Turns]:
    """Ours beside theirs, without gradients and with them."""
    torch.set_num_threads(THREADS)
    for shape in SHAPES:
        batch, size, count = shape
        given = inputs(*shape)
        for way, make in {"forward": forward, "forward and backward": both}.items():
            ours, theirs = make(fast, given), make(public, given)
            for a, b in zip(ours(), theirs(), strict=True):
                torch.testing.assert_close(a, b, rtol=1e-4, atol=1e-4 * float(b.abs().max()))
            work = f"VI, {batch} maps of {size}x{size}, {count} iterations, {way}"
            yield Turns.take(work, "public loop", elapsed(ours), elapsed(theirs), milliseconds)


def public(reward: Tensor, kernels: Tensor, iterations: int) -> tuple[Tensor, Tensor]:
    """The loop as public VIN code has it."""
    v = torch.zeros_like(reward[:, :1])  # [B, 1, H, W]
    for _ in range(iterations):
        q = conv2d(torch.cat([reward, v], 1), kernels, padding=1)
        v, _ = torch.max(q, dim=1, keepdim=True)
    return q, v.squeeze(1)


def inputs(batch: int, size: int, iterations: int) -> Inputs:
    """A reward map and kernels, both at random."""
    torch.manual_seed(0)
    reward = torch.randn(batch, 4, size, size, requires_grad=True)
    return reward, (0.2 * torch.randn(4, 5, 3, 3)).requires_grad_(), iterations


def forward(form: Form, given: Inputs) -> Work:
    """Values without gradients."""
    return torch.no_grad()(lambda: form(*given))


def both(form: Form, given: Inputs) -> Work:
    """Values, and all gradients from one of every Q."""
    down = torch.ones_like(given[0])
    return lambda: torch.autograd.grad(form(*given)[0], given[:2], down)
