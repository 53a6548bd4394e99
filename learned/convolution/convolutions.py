"""Four convolutions as a differentiable module: PyTorch's, or for batches on a CPU the loops of the file `blocks`.

PyTorch's are made for large maps: for 16 small ones they take twice as long as these.
"""

from itertools import chain
from typing import Any

import torch
from torch import Tensor, nn
from torch.autograd import Function
from torch.autograd.function import once_differentiable

from fogbench.learned.convolution.blocks import BACKWARD, FORWARD
from fogbench.learned.convolution.loops import FOUR
from fogbench.learned.convolution.sizes import shapes
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.planes import plane_size
from fogbench.learned.layers import convolution


class Convolutions(nn.Sequential):
    """Four convolutions, each before a layer that lets nothing negative pass."""

    def __init__(self, inputs: int, channels: int, outputs: int) -> None:
        """Draw the weights."""
        weights = [shape for name, shape in shapes(inputs, channels, outputs).items() if name.endswith("weight")]
        super().__init__(*(part for shape in weights for part in (convolution(shape), nn.ReLU())))
        self.fours = channels % FOUR == outputs % FOUR == 0

    def forward(self, image: Tensor) -> Tensor:
        """From images [B, inputs, H, W] to the maps of the last layer, in a row: [B, outputs * H * W]."""
        if image.is_cpu and len(image) > 1 and self.fours and not image.requires_grad:
            maps: Tensor = _Fast.apply(image, *self.parameters())  # type: ignore[no-untyped-call]  # torch's
        else:
            maps = super().forward(image)  # type: ignore[no-untyped-call]  # torch's
        return maps.flatten(1)


class _Fast(Function):
    """Of an image that needs no gradient; the parameters are kernels and biases in turn."""

    @staticmethod
    def forward(ctx: Any, image: Tensor, *parameters: Tensor) -> Tensor:
        image, (batch, inputs, height, width) = image.contiguous(), image.shape
        weights, biases = (torch.cat([part.flatten() for part in parameters[k::2]]) for k in range(2))
        channels, outputs, blocks = len(parameters[1]), len(parameters[-1]), -(-batch // LANES)
        y = image.new_empty(batch, outputs, height, width)
        tape = image.new_empty(blocks, len(biases) * plane_size(1, height, width), LANES)
        ctx.sizes = batch, height, width, inputs, channels, outputs, len(weights), len(biases)
        ctx.blocks = blocks
        FORWARD.run(image.dtype, blocks, ctx.sizes, (image, weights, biases, tape, y))
        ctx.save_for_backward(image, weights, tape, *parameters)
        return y

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, d_y: Tensor) -> tuple[Tensor | None, ...]:
        image, weights, tape, *parameters = ctx.saved_tensors
        sums = [image.new_empty(ctx.blocks, size) for size in ctx.sizes[-2:]]
        BACKWARD.run(image.dtype, ctx.blocks, ctx.sizes, (image, weights, tape, d_y.contiguous(), *sums))
        gradients = [all_.sum(0).split([part.numel() for part in parameters[k::2]]) for k, all_ in enumerate(sums)]
        pairs = zip(*gradients, strict=True)
        return None, *(gradient.view(part.shape) for part, gradient in zip(parameters, chain(*pairs), strict=True))
