"""Value iteration as a differentiable module (Tamar et al. 2016, "Value Iteration Networks"; MACN, section 3).

Words used here
    B, K, A    samples, iterations, actions (4)
    R, V, Q    reward map [B, C, H, W], value [B, H, W], value of an action [B, A, H, W]

    reward map    R = w2 * (w1 * image + b1) + b2        `*` is a convolution: w1 3x3, w2 1x1
    K times       Q = w * [R, V] + barrier,  V = max_a Q        w 3x3, the same every time, V = 0 at first

`plain` reads like these equations; `fast`, in the file of that name, computes the same many times faster on a CPU.
"""

from typing import cast

import torch
from torch import Tensor, nn
from torch.nn.functional import conv2d

from fogbench.learned.layers import convolution
from fogbench.learned.value_iteration.fast import fast
from fogbench.learned.value_iteration.sizes import ACTIONS, HIDDEN, reward_map_shapes, shapes


class RewardMap(nn.Module):
    """The reward map of an image: 3x3 to `hidden` channels, then 1x1; both are linear, so they run as one 3x3."""

    def __init__(self, channels: int, hidden: int = HIDDEN, rewards: int = ACTIONS) -> None:
        """Two convolutions with PyTorch's initial weights."""
        super().__init__()
        sizes = reward_map_shapes(channels, hidden, rewards)
        self.features = convolution(sizes["features.weight"])
        self.mix = convolution(sizes["mix.weight"])
        self.settled: tuple[Tensor, Tensor] | None = None

    def forward(self, image: Tensor) -> Tensor:
        """R [B, rewards, H, W] of an image [B, channels, H, W].

        Only the image is padded, before either convolution, so this is exact at the borders too.
        """
        return conv2d(image, *(self.settled or self.collapsed()), padding=1)

    def collapsed(self) -> tuple[Tensor, Tensor]:
        """The one kernel [rewards, channels, 3, 3] and its bias [rewards]."""
        mix = self.mix.weight.flatten(1)  # [rewards, hidden]
        bias = mix @ cast(Tensor, self.features.bias) + cast(Tensor, self.mix.bias)
        return torch.einsum("rh,hcij->rcij", mix, self.features.weight), bias

    @torch.no_grad()
    def settle(self) -> None:
        """Work them out once and for all: from now on the weights must not change."""
        self.settled = self.collapsed()


class ValueIteration(nn.Module):
    """The VI module: from an image to Q and V after K iterations."""

    def __init__(self, channels: int, iterations: int, discount: float | None = None) -> None:
        """A module with fresh weights.

        Args:
            channels: of the image.
            iterations: K, at least 1.
            discount: None leaves the value's kernels free; a number makes each a distribution over the nine
                neighbours, a softmax times this discount (Karkus et al. 2017, "QMDP-Net").
        """
        super().__init__()
        self.reward_map = RewardMap(channels)
        self.kernels = convolution(shapes(channels)["kernels"], bias=False).weight
        self.iterations = iterations
        self.discount = discount

    def forward(self, image: Tensor, barrier: Tensor | None = None) -> tuple[Tensor, Tensor]:
        """Q [B, A, H, W] and V [B, H, W] of an image [B, channels, H, W]; for `barrier` see `plain`."""
        compute = fast if image.device.type == "cpu" else plain
        return compute(self.reward_map(image), self.normalised(), self.iterations, barrier)

    def normalised(self) -> Tensor:
        """The kernels [A, A + 1, 3, 3], the last of each made a distribution if there is a discount."""
        if self.discount is None:
            return self.kernels
        reward, value = self.kernels[:, :-1], self.kernels[:, -1:]
        moves = self.discount * value.flatten(1).softmax(1).view_as(value)
        return torch.cat([reward, moves], dim=1)


def plain(reward: Tensor, kernels: Tensor, iterations: int, barrier: Tensor | None = None) -> tuple[Tensor, Tensor]:
    """Value iteration as its equations say; the gradient of a maximum goes to the first of equal actions.

    Args:
        reward: R [B, C, H, W].
        kernels: w [A, C + 1, 3, 3], the value's channel last.
        iterations: K, at least 1.
        barrier: [B, A, H, W] added to Q in every iteration: 0 where an action is available, far below all values
            where it is not. None: all are available.

    Returns:
        Q [B, A, H, W] and V [B, H, W] of the last iteration.
    """
    v = torch.zeros_like(reward[:, :1])  # [B, 1, H, W]
    for _ in range(iterations):
        q = conv2d(torch.cat([reward, v], dim=1), kernels, padding=1)
        q = q if barrier is None else q + barrier
        v, _ = q.max(dim=1, keepdim=True)
    return q, v.squeeze(1)
