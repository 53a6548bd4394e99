"""The controller of a DNC is an LSTM, by its equations and fast."""

import pytest
import torch
from torch import Tensor, nn

from fogbench.learned.dnc.controller import Controller

INPUTS = 5


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
@pytest.mark.parametrize("hidden", [7, 32])
@pytest.mark.parametrize("batch", [(), (1,), (9,)])
@pytest.mark.parametrize("fast", [True, False])
def test_it_is_the_lstm_of_pytorch(fast: bool, batch: tuple[int, ...], hidden: int, dtype: torch.dtype) -> None:
    """With the same weights, values and gradients are those of `nn.LSTMCell`; gates may be anything from -50 to 50."""
    torch.manual_seed(0)
    mine, theirs = Controller(INPUTS, hidden).to(dtype), nn.LSTMCell(INPUTS, hidden).to(dtype)
    with torch.no_grad():
        mine.weight.copy_(torch.cat([theirs.weight_ih, theirs.weight_hh], -1))
        mine.bias.copy_(theirs.bias_ih + theirs.bias_hh)
    x, h, c = (torch.randn(*batch, size, dtype=dtype, requires_grad=True) for size in (INPUTS, hidden, hidden))
    for scale in (1, 50):
        got, expected = mine(x * scale, (h, c), fast=fast), theirs(x * scale, (h, c))
        torch.testing.assert_close(got, expected)
        down = [torch.randn_like(c), torch.randn_like(c)]
        found = torch.autograd.grad(got, [x, h, c, mine.weight, mine.bias], down)
        by_x, by_h, by_c, by_input, by_hidden, by_bias = torch.autograd.grad(
            expected, [x, h, c, theirs.weight_ih, theirs.weight_hh, theirs.bias_ih], down
        )
        wanted: list[Tensor] = [by_x, by_h, by_c, torch.cat([by_input, by_hidden], -1), by_bias]
        for one, other in zip(found, wanted, strict=True):
            assert (one - other).norm() <= (1e-9 if dtype is torch.float64 else 1e-5) * other.norm()


def test_a_fresh_one_remembers() -> None:
    """Its forget gates' biases are drawn around 1, all others around 0, no farther off than 1 / sqrt(hidden)."""
    torch.manual_seed(0)
    biases = Controller(INPUTS, 64).bias.view(4, 64)  # input, forget, candidate, output
    off = biases - torch.tensor([0, 1, 0, 0])[:, None]
    assert 0.1 < off.abs().max() <= 0.125
