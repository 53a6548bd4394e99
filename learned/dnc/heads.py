"""The sizes of a memory access that its interface depends on. Importing this imports no torch."""

from math import prod
from typing import NamedTuple


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
    def interface_shapes(self) -> tuple[tuple[int, int], tuple[int, int]]:
        """What the controller gives to the write heads and to the read heads."""
        return (self.writes, 3 * self.word + 3), (self.reads, self.word + 2 * self.linked + 3)

    @property
    def interface(self) -> int:
        """How many numbers that are."""
        return sum(map(prod, self.interface_shapes))
