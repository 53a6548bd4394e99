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
    kept: int = 0
    """Links of a row that are kept, the strongest (Rae et al. 2016); 0: all."""

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

    def state_shapes(self, rows: int, room: int = 0) -> tuple[Shape, ...]:
        """What a sample's state has, in the order of `AccessState`, or what `room` for more rows has."""
        whole = room or rows
        read, write, linked = (self.reads, whole), (self.writes, whole), (self.linked, whole)
        links = self.linked, 2 * self.strongest(rows) or whole, whole
        return (self.word, whole), read, write, (whole,), links, linked

    def strongest(self, rows: int) -> int:
        """`S`, how many links each of so many rows keeps; 0: all."""
        return min(self.kept, rows)


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
