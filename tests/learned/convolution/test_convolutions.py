"""The fast convolutions, held against PyTorch's."""

import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from torch import Tensor, nn

from fogbench.learned.convolution.convolutions import Convolutions


def plain(convolutions: Convolutions, image: Tensor) -> Tensor:
    """The same layers, each as PyTorch has it."""
    return nn.Sequential.forward(convolutions, image).flatten(1)  # type: ignore[no-untyped-call]  # torch's


def both_ways(maps: Tensor, convolutions: Convolutions) -> list[Tensor]:
    """The maps, and the gradients of a random function of them."""
    weights = torch.randn(maps.shape, generator=torch.Generator().manual_seed(1), dtype=maps.dtype)
    return [maps, *torch.autograd.grad((maps * weights).sum(), list(convolutions.parameters()))]


@settings(max_examples=60)
@given(
    batch=st.sampled_from([2, 3, 16, 17, 40]),
    height=st.integers(1, 9),
    width=st.integers(1, 9),
    channels=st.sampled_from([4, 8, 16, 20]),
    threads=st.sampled_from([1, 2]),
    seed=st.integers(0, 999),
)
def test_maps_and_gradients_are_those_of_pytorch(
    batch: int, height: int, width: int, channels: int, threads: int, seed: int
) -> None:
    """For maps of any size, on one thread and on two."""
    torch.manual_seed(seed)
    convolutions = Convolutions(3, channels, 4).double()
    image, before = torch.randn(batch, 3, height, width, dtype=torch.float64), torch.get_num_threads()
    torch.set_num_threads(threads)
    try:
        fast = both_ways(convolutions(image), convolutions)
    finally:
        torch.set_num_threads(before)
    for mine, theirs in zip(fast, both_ways(plain(convolutions, image), convolutions), strict=True):
        torch.testing.assert_close(mine, theirs, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("channels", [3, 6])
def test_channels_that_are_no_fours_are_left_to_pytorch(channels: int) -> None:
    """To the bit; so is an image that needs a gradient, or is alone."""
    torch.manual_seed(0)
    convolutions, image = Convolutions(3, channels, 4), torch.randn(5, 3, 7, 7)
    assert torch.equal(convolutions(image), plain(convolutions, image))
    four = Convolutions(3, 4, 4)
    alone, image = image[:1], image.requires_grad_()
    assert torch.equal(four(alone), plain(four, alone))
    (gradient,) = torch.autograd.grad(four(image).square().sum(), image)
    assert gradient.abs().sum() > 0


def test_what_is_no_number_stays_so() -> None:
    """NaN spreads as far as PyTorch spreads it."""
    torch.manual_seed(0)
    convolutions, image = Convolutions(3, 4, 4), torch.randn(3, 3, 7, 7)
    image[1, 2, 3, 3] = torch.nan
    assert torch.equal(convolutions(image).isnan(), plain(convolutions, image).isnan())


def test_a_sample_is_the_same_in_any_batch() -> None:
    """Whoever stands beside it, on however many threads."""
    torch.manual_seed(0)
    convolutions, image = Convolutions(3, 16, 4), torch.randn(40, 3, 7, 7)
    assert torch.equal(convolutions(image)[17:33], convolutions(image[17:33]))
