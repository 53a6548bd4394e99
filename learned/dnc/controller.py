"""The controller of a DNC: one step of an LSTM (Hochreiter and Schmidhuber 1997), as its equations and fast on a CPU.

Words used here
    x, h, c    input [..., inputs], output [..., H], cell [..., H]
    z          the gates before they are squashed: input, forget, candidate, output, [..., 4 * H] in this order

    z = W [x, h] + b
    c <- sigmoid(z_forget) * c + sigmoid(z_input) * tanh(z_candidate),   h <- sigmoid(z_output) * tanh(c)
"""

from typing import Any

import torch
from llvmlite.binding import get_host_cpu_name
from torch import Tensor, nn
from torch.autograd import Function
from torch.autograd.function import once_differentiable
from torch.nn.functional import linear

from fogbench.learned.dnc.controller_kernels import BACKWARD, FORWARD
from fogbench.learned.dnc.heads import controller_shapes
from fogbench.learned.kernels.lanes import LANES


class Controller(nn.Module):
    """W and b, drawn as PyTorch draws those of an LSTM; the forget gates' biases are 1 higher.

    So a fresh controller forgets over several steps and not at once, and learns what it must know much later (Gers et
    al. 2000; Jozefowicz et al. 2015, "An empirical exploration of recurrent network architectures").
    """

    def __init__(self, inputs: int, hidden: int) -> None:
        """Draw the weights."""
        super().__init__()
        bound, sizes = hidden**-0.5, controller_shapes(inputs, hidden)
        self.hidden = hidden
        self.weight = nn.Parameter(torch.empty(sizes["weight"]).uniform_(-bound, bound))
        self.bias = nn.Parameter(torch.empty(sizes["bias"]).uniform_(-bound, bound))
        with torch.no_grad():
            self.bias[hidden : 2 * hidden] += 1

    def forward(self, x: Tensor, state: tuple[Tensor, Tensor], *, fast: bool = True) -> tuple[Tensor, Tensor]:
        """The next h and c, of x and the last h and c; `fast` is for float32 and float64 on a CPU."""
        h, c = state
        inputs = torch.cat([x, h], -1)
        if fast and inputs.is_cpu and self.hidden % LANES == 0:
            h, c = _Fast.apply(inputs, self.weight, self.bias, c)  # type: ignore[no-untyped-call]  # torch's
            return h, c
        write, forget, candidate, output = linear(inputs, self.weight, self.bias).chunk(4, -1)
        c = forget.sigmoid() * c + write.sigmoid() * candidate.tanh()
        return output.sigmoid() * c.tanh(), c


class _Fast(Function):
    """The gates of a sample lie in a row, so sixteen of them are squashed at a time."""

    @staticmethod
    def forward(ctx: Any, inputs: Tensor, weight: Tensor, bias: Tensor, cell: Tensor) -> tuple[Tensor, Tensor]:
        cell = cell.contiguous()
        gates = product(inputs, weight, bias)
        h, c, tanh = cell.new_empty(3, *cell.shape)
        size = cell.shape[-1]
        FORWARD.run(gates.dtype, cell.numel() // size, (size,), (gates, cell, h, c, tanh))
        ctx.save_for_backward(inputs, weight, cell, gates, tanh)
        return h, c

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, d_h: Tensor, d_c: Tensor) -> tuple[Tensor, Tensor, Tensor, Tensor]:
        inputs, weight, cell, gates, tanh = ctx.saved_tensors
        d_h, d_c, d_gates, d_cell = d_h.contiguous(), d_c.contiguous(), torch.empty_like(gates), torch.empty_like(cell)
        size = cell.shape[-1]
        BACKWARD.run(gates.dtype, cell.numel() // size, (size,), (gates, cell, d_h, d_c, tanh, d_gates, d_cell))
        rows, d_rows = inputs.reshape(-1, inputs.shape[-1]), d_gates.reshape(-1, d_gates.shape[-1])
        return product(d_gates, weight.T), product(d_rows.T, rows.T), d_rows.sum(0), d_cell


_ONEDNN = getattr(torch.ops.mkldnn, "_linear_pointwise", None) if get_host_cpu_name().startswith("znver") else None


def product(x: Tensor, weight: Tensor, bias: Tensor | None = None) -> Tensor:
    """`linear`, on a processor of AMD by oneDNN, where MKL's matrix products are slow.

    Not for one row, where oneDNN is slower, or for none, which it refuses.
    """
    if _ONEDNN is None or x.dtype is not torch.float32 or x.numel() in {0, x.shape[-1]}:
        return linear(x, weight, bias)
    result: Tensor = _ONEDNN(x, weight, bias, "none", [], "")
    return result
