"""How much a network sees of a grid, and how many outputs it has. Importing this imports no torch."""

from typing import NamedTuple

from fogbench.worlds.mistake import Mistake

CHANNELS = 3
"""Of an image: free, blocked, goal; a cell that is neither free nor blocked is unknown."""

SIGHT = 3
"""Cells to each side that a controller sees as they are: the paper's 7x7; with a smaller sensor the rest is unknown."""

SEEN = CHANNELS * (2 * SIGHT + 1) ** 2
"""Numbers of a sight."""

COMPASS = 12
"""Numbers of a compass: sign, logarithm and clamped size of both offsets to the goal; last move, one of 5; blocked."""

OUTPUTS = ("down", "right", "up", "left")
"""What the outputs of a network mean: the four moves, in the order of `Move`."""


def by(extent: tuple[float, ...]) -> str:
    """A size in words: `6x9`."""
    return "x".join(map(str, extent))


class Frame(NamedTuple):
    """Which part of the world an image shows."""

    shape: tuple[int, int]
    """Rows and columns of the image."""
    centred: bool
    """Whether the agent is in its middle (`window`); else it is the whole map, from its first cell on (`map`)."""

    def check(self, extent: tuple[float, ...]) -> None:
        """Hold it against the extent of a map.

        Raises:
            Mistake: a network that was made for maps of one size meets another.
        """
        if not self.fits(extent):
            raise Mistake(f"got a map of {by(extent)}; expected {by(self.shape)}, the size")

    def fits(self, extent: tuple[float, ...] | None) -> bool:
        """Whether it can show maps of some extent; of maps that differ that is not known yet."""
        return self.centred or extent in (None, self.shape)
