"""What a moment of an episode looks like, in layers: no pixels, so that a PNG, a film and a page can draw the same.

Points are `(row, column)` in the units of the world's own picture; the centre of a cell is at whole numbers.
"""

from typing import Any, NamedTuple

from numpy.typing import NDArray

Array = NDArray[Any]


class Cells(NamedTuple):
    """A whole map of cells."""

    readings: Array
    """[H, W] uint8 of UNKNOWN, FREE, BLOCKED."""


class Squares(NamedTuple):
    """Some cells."""

    at: Array
    """[n, 2] int, row and column of each."""


class Lines(NamedTuple):
    """Straight lines, such as edges of a graph, beams or a driven path."""

    ends: Array
    """[n, 2, 2] float, the points at both ends of each."""


class Dots(NamedTuple):
    """Points that are drawn large enough to be seen."""

    at: Array
    """[n, 2] float."""


Layer = Cells | Squares | Lines | Dots


class Picture(NamedTuple):
    """One moment; `truth` or `known` lies below, the others over it."""

    extent: tuple[float, float]
    """Rows and columns that the picture is high and wide."""
    truth: tuple[Layer, ...]
    """What is."""
    known: tuple[Layer, ...]
    """What the agent has seen of it."""
    view: Layer
    """What the sensor shows now."""
    path: Layer
    """Where the agent was."""
    agent: Layer
    goal: Layer
