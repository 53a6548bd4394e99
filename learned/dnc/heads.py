"""The sizes of a differentiable neural computer, which need no PyTorch; the letters are those of the file `access`."""

from math import prod
from typing import NamedTuple

from fogbench.learned.shapes import Shape, Shapes, linear, parts


class Heads(NamedTuple):
    """The sizes of a memory access that its interface depends on: not the number of rows."""

    reads: int = 4
    writes: int = 1
    word: int = 8
    links: bool = True

    @property
    def linked(self) -> int:
        """`K`."""
        return self.writes if self.links else 0

    @property
    def read(self) -> int:
        """How many numbers all read heads read."""
        return self.reads * self.word

    @property
    def interface_shapes(self) -> tuple[tuple[int, int], tuple[int, int]]:
        """What the controller gives to the write heads and to the read heads."""
        return (self.writes, 3 * self.word + 3), (self.reads, self.word + 2 * self.linked + 3)

    @property
    def interface(self) -> int:
        """How many numbers that are."""
        return sum(map(prod, self.interface_shapes))

    def state_shapes(self, rows: int) -> tuple[Shape, ...]:
        """What a sample's state has, in the order of `AccessState`."""
        read, write, linked = (self.reads, rows), (self.writes, rows), (self.linked, rows)
        return (self.word, rows), read, write, (rows,), (*linked, rows), linked


def controller_shapes(inputs: int, hidden: int) -> Shapes:
    """The weights of a `Controller` with these arguments."""
    return linear(inputs + hidden, 4 * hidden)


def shapes(inputs: int, outputs: int, heads: Heads, hidden: int) -> Shapes:
    """The weights of a `DNC` with these arguments."""
    return parts(
        controller=controller_shapes(inputs + heads.read, hidden),
        interface=linear(hidden, heads.interface),
        output=linear(hidden + heads.read, outputs),
    )
