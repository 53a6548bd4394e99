"""What networks that plan on an image see, in any kind of world.

Words used here
    B, H, W    samples, rows and columns of the image
"""

from typing import Protocol

from torch import Tensor


class Images(Protocol):
    """**Protocol:** inputs with an image to plan on."""

    @property
    def image(self) -> Tensor:
        """[B, 3, H, W] float32."""

    @property
    def cells(self) -> Tensor:
        """[B] int64, where the agents are in the image: row * W + column."""

    @property
    def beside(self) -> tuple[Tensor, ...]:
        """[B, any], what a memory is told as it is."""


def here(maps: Tensor, cells: Tensor) -> Tensor:
    """What maps [B, C, H, W] say at the agents' cells [B]: [B, C]."""
    at = cells[:, None, None].expand(-1, maps.shape[1], 1)  # [B, C, 1]
    return maps.flatten(2).gather(2, at)[..., 0]
