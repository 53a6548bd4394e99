"""What a network of the harness is, and the states that it carries from step to step: nested tuples of tensors."""

from collections.abc import Iterator
from typing import Any, Protocol, runtime_checkable

from torch import Tensor, nn

from fogbench.worlds.mistake import Mistake


@runtime_checkable
class Settling(Protocol):
    """**Protocol:** a part of a network that decides faster once its weights no longer change."""

    def settle(self) -> None:
        """From now on they do not."""


class Network(nn.Module):
    """A network that takes one step at a time; its inputs are what the encoding of its kind of world makes."""

    def blank(self, batch: tuple[int, ...]) -> Any:
        """The state before the first step: nested tuples of tensors [*batch, ...]."""
        raise NotImplementedError

    def plan(self, inputs: Any) -> Tensor:
        """What the network makes of the image, before anything is remembered: [B, planned].

        Only `fogbench look` asks for it.

        Raises:
            Mistake: this network does not tell.
        """
        del inputs
        raise Mistake(f"{type(self).__name__}: got no `plan`; expected what the network makes of the image.")

    def forward(self, inputs: Any, state: Any) -> tuple[Tensor, Any]:
        """From what is seen and the state before to the scores [B, A] of the outputs and the state after."""
        raise NotImplementedError


def settled(network: Network) -> Network:
    """A network whose weights will not change any more."""
    for part in network.requires_grad_(False).modules():
        if isinstance(part, Settling):
            part.settle()
    return network


def tensors(state: Any) -> Iterator[Tensor]:
    """All tensors of a network's state."""
    if isinstance(state, Tensor):
        yield state
    else:
        for part in state:
            yield from tensors(part)


def rows(state: Any, kept: Tensor) -> Any:
    """The state of some samples of a batch: those of the numbers, or of the truth values, in `kept`."""
    if isinstance(state, Tensor):
        return state[kept]
    parts = (rows(part, kept) for part in state)
    return type(state)(*parts) if hasattr(state, "_fields") else tuple(parts)
