"""Value iteration: the equations, the tables they stand for, and the fast form that must agree with them."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from unittest.mock import patch

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from torch import Tensor

from fogbench.learned.value_iteration.fast import fast
from fogbench.learned.value_iteration.value_iteration import RewardMap, ValueIteration, plain
from fogbench.worlds.types import DELTAS, Array

Form = Callable[..., tuple[Tensor, Tensor]]
FORMS: tuple[Form, ...] = (plain, fast)
TOLERANCE = {torch.float64: 1e-5, torch.float32: 1e-4}


def grid_kernels(discount: float) -> Tensor:
    """Kernels [4, 2, 3, 3] of the four moves: a cell's own reward, and the discounted value where the move leads."""
    kernels = torch.zeros(4, 2, 3, 3, dtype=torch.float64)
    kernels[:, 0, 1, 1] = 1
    for action, (down, right) in enumerate(DELTAS):
        kernels[action, 1, 1 + down, 1 + right] = discount
    return kernels


def table(reward: Array, barrier: Array, discount: float, iterations: int) -> tuple[Array, Array]:
    """Tabular value iteration, cell by cell: Q [4, H, W] and V [H, W]; outside the map the value is 0."""
    height, width = reward.shape
    v = np.zeros((height, width))
    for _ in range(iterations):
        q = np.empty((4, height, width))
        for y, x in np.ndindex(height, width):
            for action, (down, right) in enumerate(DELTAS):
                inside = 0 <= y + down < height and 0 <= x + right < width
                after = v[y + down, x + right] if inside else 0.0
                q[action, y, x] = reward[y, x] + discount * after + barrier[action, y, x]
        v = q.max(0)
    return q, v


def drawn(seed: int, *shape: int, dtype: torch.dtype = torch.float64) -> Tensor:
    """Normal numbers that want a gradient."""
    rng = torch.Generator().manual_seed(seed)
    return torch.randn(shape, generator=rng, dtype=dtype).requires_grad_()


@contextmanager
def threads_of_torch(threads: int) -> Iterator[None]:
    """As many threads of PyTorch for a while."""
    before = torch.get_num_threads()
    torch.set_num_threads(threads)
    yield
    torch.set_num_threads(before)


def apart(a: Tensor, b: Tensor) -> float:
    """How far b is from a, in norm, beside a's own norm."""
    return ((a - b).norm() / a.norm().clamp_min(1e-30)).item()


@pytest.mark.parametrize("form", FORMS)
def test_equals_the_table(form: Form) -> None:
    """With the grid's moves for kernels, both forms are tabular value iteration, on 200 random maps with walls."""
    rng = np.random.default_rng(0)
    for _ in range(200):
        height, width = rng.integers(1, 9, 2)
        reward = rng.normal(size=(height, width))
        barrier = np.where(rng.random((4, height, width)) < 0.3, -1000.0, 0.0)
        iterations, discount = int(rng.integers(1, 12)), rng.uniform(0.5, 1)
        inputs = torch.tensor(reward)[None, None], grid_kernels(discount), iterations, torch.tensor(barrier)[None]
        q, v = form(*inputs)
        expected_q, expected_v = table(reward, barrier, discount, iterations)
        np.testing.assert_allclose(q[0], expected_q, rtol=0, atol=1e-5)
        np.testing.assert_allclose(v[0], expected_v, rtol=0, atol=1e-5)


@settings(max_examples=60)
@given(
    seed=st.integers(0, 10_000),
    batch=st.integers(1, 70),
    channels=st.integers(1, 5),
    size=st.tuples(st.integers(1, 12), st.integers(1, 12)),
    iterations=st.integers(1, 10),
    scale=st.floats(0.01, 0.5),
    dtype=st.sampled_from(list(TOLERANCE)),
    density=st.sampled_from([1.0, 0.1]),
    wanted=st.sampled_from(["q", "v", "both"]),
    walls=st.booleans(),
    threads=st.sampled_from([1, 2, 3]),
)
def test_fast_equals_plain(
    seed: int,
    batch: int,
    channels: int,
    size: tuple[int, int],
    iterations: int,
    scale: float,
    dtype: torch.dtype,
    density: float,
    wanted: str,
    walls: bool,
    threads: int,
) -> None:
    """Values and all gradients agree in norm, for gradients of Q, of V or of both, dense or sparse."""
    reward = drawn(seed, batch, channels, *size, dtype=dtype)
    kernels = (scale * drawn(seed + 1, 4, channels + 1, 3, 3, dtype=dtype)).detach().requires_grad_()
    barrier = drawn(seed + 2, batch, 4, *size, dtype=dtype) if walls else None
    inputs = [reward, kernels] if barrier is None else [reward, kernels, barrier]
    found = []
    for form in FORMS:
        with threads_of_torch(threads):
            q, v = form(reward, kernels, iterations, barrier)
            results = {"q": [q], "v": [v], "both": [q, v]}[wanted]
            grads = [drawn(seed + 3 + i, *x.shape, dtype=dtype).detach() for i, x in enumerate(results)]
            masks = [torch.rand(x.shape, generator=torch.Generator().manual_seed(seed)) < density for x in results]
            given = [grad * mask for grad, mask in zip(grads, masks, strict=True)]
            found.append([q, v, *torch.autograd.grad(results, inputs, given)])
    for exact, quick in zip(*found, strict=True):
        assert apart(exact, quick) < TOLERANCE[dtype]


def test_no_gradient_no_history() -> None:
    """Without gradients, where two values take turns, the results are the same bits."""
    reward, kernels = drawn(0, 37, 4, 5, 6), drawn(1, 4, 5, 3, 3)
    for iterations in (1, 2, 5):
        kept = fast(reward, kernels, iterations)
        with torch.no_grad():
            forgotten = fast(reward, kernels, iterations)
        assert all(torch.equal(a, b) for a, b in zip(kept, forgotten, strict=True))


def test_threads_may_change_on_the_way() -> None:
    """Gradients are the same bits where PyTorch has other threads on the way back."""
    reward, kernels = drawn(0, 12, 4, 5, 6), drawn(1, 4, 5, 3, 3)
    found = []
    for threads in (1, 3):
        with threads_of_torch(1):
            q, _ = fast(reward, kernels, 4)
        with threads_of_torch(threads):
            found.append(torch.autograd.grad(q.sum(), [reward, kernels]))
    assert all(torch.equal(a, b) for a, b in zip(*found, strict=True))


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("tied", [(0, 1, 2, 3), (1, 2, 3), (2, 3), (1, 3)])
def test_ties_go_to_the_first_action(form: Form, tied: tuple[int, ...]) -> None:
    """Of actions with the same kernels and the largest values, only the first gets a gradient from V."""
    reward = torch.ones(3, 1, 4, 4)
    kernels = torch.zeros(4, 2, 3, 3)
    kernels[list(tied)] = 0.25
    kernels.requires_grad_()
    _, v = form(reward, kernels, 6)
    v.sum().backward()
    assert kernels.grad is not None
    touched = kernels.grad.flatten(1).abs().sum(1) > 0
    assert touched.nonzero().flatten().tolist() == [tied[0]]


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("action", range(4))
@pytest.mark.parametrize("iterations", [1, 2])
def test_nan_is_not_hidden(form: Form, action: int, iterations: int) -> None:
    """NaN in the Q of any one action is in V too, and from there in the Q of its neighbours and no farther."""
    barrier = torch.zeros(1, 4, 5, 5)
    barrier[0, action, 2, 2] = torch.nan
    q, v = form(torch.ones(1, 1, 5, 5), torch.ones(4, 2, 3, 3), iterations, barrier)
    expected = torch.zeros(5, 5, dtype=torch.bool)
    reach = iterations - 1
    expected[2 - reach : 3 + reach, 2 - reach : 3 + reach] = True
    assert torch.equal(v[0].isnan(), expected)
    assert torch.equal(q[0].isnan().any(0), expected)


def test_gradcheck() -> None:
    """The gradients of the plain form are those of its values, by finite differences."""
    inputs = drawn(0, 2, 2, 3, 4), drawn(1, 4, 3, 3, 3), drawn(2, 2, 4, 3, 4)
    assert torch.autograd.gradcheck(lambda reward, kernels, barrier: plain(reward, kernels, 3, barrier), inputs)


@pytest.mark.parametrize("iterations", [1, 7])
def test_plain_costs_one_convolution_an_iteration(iterations: int) -> None:
    """The reference convolves exactly K times: neither cleverer nor slower than its equations."""
    with patch("fogbench.learned.value_iteration.value_iteration.conv2d", wraps=torch.conv2d) as convolve:
        plain(torch.zeros(1, 4, 3, 3), torch.zeros(4, 5, 3, 3), iterations)
    assert convolve.call_count == iterations


def test_reward_map_is_its_two_convolutions() -> None:
    """The one convolution equals the 3x3 and the 1x1 with their biases: values, borders and all gradients."""
    torch.manual_seed(0)
    two = RewardMap(2).double()
    for image in (drawn(0, 3, 2, 6, 5), drawn(1, 2, 2, 1, 1)):
        inputs = [image, *two.parameters()]
        expected, found = two.mix(two.features(image)), two(image)
        torch.testing.assert_close(found, expected, rtol=1e-12, atol=1e-12)
        down = torch.randn_like(found)
        pairs = (torch.autograd.grad(result, inputs, down) for result in (expected, found))
        for a, b in zip(*pairs, strict=True):
            torch.testing.assert_close(a, b, rtol=1e-10, atol=1e-10)


def test_a_settled_reward_map_is_the_same() -> None:
    """It gives what it gave before, bit for bit."""
    image, reward_map = torch.randn(2, 3, 5, 6), RewardMap(3)
    before = reward_map(image)
    reward_map.settle()
    assert torch.equal(reward_map(image), before)
    assert not reward_map(image).requires_grad


def test_module_is_its_parts() -> None:
    """The module computes value iteration of its reward map with its kernels."""
    module = ValueIteration(2, iterations=5)
    image = torch.rand(3, 2, 7, 7)
    for a, b in zip(module(image), plain(module.reward_map(image), module.kernels, 5), strict=True):
        torch.testing.assert_close(a, b)


def test_discount_makes_the_value_kernels_distributions() -> None:
    """With a discount, each value kernel is positive and sums to it; the reward's kernels stay as they are."""
    module = ValueIteration(2, iterations=5, discount=0.9)
    kernels = module.normalised()
    torch.testing.assert_close(kernels[:, :4], module.kernels[:, :4])
    assert (kernels[:, 4] > 0).all()
    torch.testing.assert_close(kernels[:, 4].flatten(1).sum(1), torch.full((4,), 0.9))
