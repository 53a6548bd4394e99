"""Value iteration beside its plain form, and its rate beside a matrix product's, on two threads.

    pytest bench/timing/test_value_iteration.py -s

In each round all take their turn, so that what else the machine does falls on all; the ratios are medians over rounds.
A turn is one call; a second one right after, which finds its code and its inputs in the cache, is told by its rate.
"""

from collections.abc import Callable
from time import perf_counter

import numpy as np
import pytest
import torch
from pytest_benchmark.fixture import BenchmarkFixture
from torch import Tensor

from fogbench.learned.value_iteration.fast import fast
from fogbench.learned.value_iteration.value_iteration import plain

THREADS = 2
ROUNDS = 15
SIDE = 2048
SHAPES = [(128, 16, 20), (32, 32, 40), (8, 64, 80), (512, 11, 16)]
"""Batch, rows and columns of a map, iterations."""

Form = Callable[[Tensor, Tensor, int], tuple[Tensor, Tensor]]


def inputs(batch: int, size: int) -> tuple[Tensor, Tensor, Tensor]:
    """A reward map, kernels and a gradient of every Q."""
    torch.manual_seed(0)
    reward = torch.randn(batch, 4, size, size, requires_grad=True)
    kernels = (0.2 * torch.randn(4, 5, 3, 3)).requires_grad_()
    return reward, kernels, torch.randn(batch, 4, size, size)


def forward(form: Form, shape: tuple[int, int, int]) -> Callable[[], object]:
    """Values without gradients."""
    batch, size, iterations = shape
    reward, kernels, _ = inputs(batch, size)
    return torch.no_grad()(lambda: form(reward, kernels, iterations))


def both(form: Form, shape: tuple[int, int, int]) -> Callable[[], object]:
    """Values, and all gradients from a dense one."""
    batch, size, iterations = shape
    reward, kernels, down = inputs(batch, size)
    return lambda: torch.autograd.grad(form(reward, kernels, iterations)[0], [reward, kernels], down)


@pytest.mark.parametrize("shape", SHAPES, ids=str)
@pytest.mark.parametrize("way", [forward, both])
@pytest.mark.parametrize("form", [plain, fast])
def test_form(
    benchmark: BenchmarkFixture, form: Form, way: Callable[..., Callable[[], object]], shape: tuple[int, int, int]
) -> None:
    """Each form by itself."""
    benchmark.group = f"VI {way.__name__} {shape}"
    benchmark(way(form, shape))


@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_ratios(shape: tuple[int, int, int]) -> None:
    """How many times as fast as the plain form, and the share of the matrix product's rate, taking turns."""
    batch, size, iterations = shape
    left = torch.randn(SIDE, SIDE)
    turns = [forward(plain, shape), forward(fast, shape), both(plain, shape), both(fast, shape), lambda: left @ left]
    times = np.array([[seconds(turn) for turn in turns] for _ in range(ROUNDS + 1)])[1:]  # [rounds, turns, 2]
    rates = 2 * 9 * 4 * batch * size**2 * iterations / times[:, 1]  # [rounds, 2]
    share = np.median(rates[:, 0] / (2 * SIDE**3 / times[:, 4, 0]))
    first, second = np.median(rates, 0) / 1e9
    ahead, both_ways = (np.median(times[:, i, 0] / times[:, i + 1, 0]) for i in (0, 2))
    print(
        f"\n{shape}: forward {ahead:.1f} times the plain form, with backward {both_ways:.1f}; "
        f"{first:.0f} GFLOP/s, {share:.0%} of a {SIDE}x{SIDE} product; a second call {second:.0f} GFLOP/s"
    )


def seconds(turn: Callable[[], object]) -> tuple[float, float]:
    """Seconds of a call, and of another right after."""
    began = perf_counter()
    turn()
    between = perf_counter()
    turn()
    return between - began, perf_counter() - between
