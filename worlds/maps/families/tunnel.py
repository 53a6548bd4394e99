"""Tunnels: a cul-de-sac between the agent and its goal (Khan et al. 2018, section 4.2).

Words used here
    axis    the middle line of the corridor, from the cell in the mouth to the last cell before the end wall
    corner  a cell of the axis where it begins, turns or ends
    half    cells of the corridor on each side of its axis
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from fogbench.worlds.maps.layout import CellConditions, DrawnMaps, Layout
from fogbench.worlds.maps.split import split
from fogbench.worlds.settings import SIDE, Probability, Range, ascending
from fogbench.worlds.types import DELTAS, Array, Cell

MARGIN = 2
"""Free cells around the walls, at least."""

Cells = Annotated[int, Field(ge=1, le=1_000_000)]
"""Of an axis."""


class Tunnel(DrawnMaps):
    """A walled corridor in a free area; the agent starts in it, and its goal lies at, or behind, the far end.

    The mouth faces any of the four directions. Turns to the left and to the right are equally likely, but the corridor
    never runs back towards its mouth. The goal counts only after a cell of the end wall was in view from inside the
    corridor; where the far end is open there is no such wall, and the goal always counts.
    """

    length: Annotated[tuple[Cells, Cells], AfterValidator(ascending)]
    """Cells of the axis, drawn uniformly."""
    width: Literal[1, 3] = 1
    """Inner width [cells]."""
    open: Probability = 0.0
    """Probability that the far end is open."""
    bends: Range = (0, 0)
    """How many quarter turns the corridor takes, drawn uniformly."""
    goal: Literal["behind", "inside"] = "behind"
    """Just behind the end wall, or on the last cell of the axis."""

    @model_validator(mode="after")
    def _long_enough(self) -> "Tunnel":
        if self.bends[1] and self.length[1] > 2 * SIDE:
            raise ValueError(f"a length of at most {2 * SIDE:,} where there are bends")
        least = (self.bends[1] + 1) * (self.width + 1)
        if self.length[0] < least:
            raise ValueError(f"a length from {least}, for {self.bends[1]} bends and width {self.width}")
        return self

    def draw(self, rng: np.random.Generator, conditions: CellConditions) -> Layout:
        """A tunnel with its task; the start is uniform over the corridor."""
        half = self.width // 2
        corners = self._corners(rng)  # [segments + 1, 2]
        corners += half + 1 + MARGIN - corners.min(0)
        out = _direction(corners[-2], corners[-1])
        wall = corners[-1] + out
        end = _across(wall, out, half)
        inner, blocked = _walled(corners, half)
        goal = _cell(corners[-1] if self.goal == "inside" else wall + out)
        start = _start(inner, goal, rng)
        if rng.random() < self.open:
            blocked[end] = False
            return Layout(blocked, start, goal)
        return Layout(blocked, start, goal, _posts(inner, blocked, end, conditions))

    def moments(self, world: Any, path: Sequence[Any]) -> dict[str, int]:
        """The steps of the end wall first in view, of the turn and of the exit (Khan et al. 2018, appendix B.3)."""
        from fogbench.worlds.maps.moments import in_tunnel  # noqa: PLC0415  it loads SciPy, which no episode needs

        return in_tunnel(world.blocked, world.posts, self.width, path)

    def _corners(self, rng: np.random.Generator) -> Array:
        length = int(rng.integers(*self.length, endpoint=True))
        bends = int(rng.integers(*self.bends, endpoint=True))
        ahead = np.array(DELTAS[rng.integers(4)])  # [2]
        moves = np.array(split(length, bends + 1, self.width + 1, rng))  # [segments], each leaves room for a wall
        moves[0] -= 1  # the mouth's own cell
        moves[1::2] *= rng.choice([-1, 1], size=len(moves[1::2]))
        directions = np.where(np.arange(len(moves))[:, None] % 2, ahead[::-1], ahead)  # [segments, 2]
        return np.vstack([np.zeros((1, 2), np.int64), np.cumsum(moves[:, None] * directions, 0)])  # [segments + 1, 2]


def _walled(corners: Array, half: int) -> tuple[Array, Array]:
    """The cells of the corridor, and the blocked cells around it, both [H, W] bool."""
    shape = tuple(corners.max(0) + half + 2 + MARGIN)
    inner, blocked = np.zeros(shape, np.bool_), np.zeros(shape, np.bool_)  # [H, W]
    into, out = _direction(corners[0], corners[1]), _direction(corners[-2], corners[-1])
    middle = corners.copy()  # of squares as wide as the corridor that just fill it
    middle[0] += half * into
    middle[-1] -= half * out
    for a, b in pairwise(middle):
        blocked[_box(a, b, half + 1)] = True
    for a, b in pairwise(middle):
        inner[_box(a, b, half)] = True
        blocked[_box(a, b, half)] = False
    blocked[_across(corners[0] - into, into, half + 1)] = False  # the mouth
    return inner, blocked


def _posts(inner: Array, blocked: Array, wall: tuple[slice, slice], conditions: CellConditions) -> frozenset[Cell]:
    """Cells of the corridor from which the sensor shows a cell of the end wall."""
    ends = [(r, c) for r in range(wall[0].start, wall[0].stop) for c in range(wall[1].start, wall[1].stop)]
    places = np.argwhere(inner)  # [n, 2]
    shown = np.any([conditions.shows(blocked, end, places) for end in ends], 0)  # [n]
    return frozenset((row, column) for row, column in places[shown].tolist())


def _start(inner: Array, goal: Cell, rng: np.random.Generator) -> Cell:
    cells = np.flatnonzero(inner)  # [n]
    cells = cells[cells != goal[0] * inner.shape[1] + goal[1]]
    row, column = divmod(int(rng.choice(cells)), inner.shape[1])
    return row, column


def _direction(a: Array, b: Array) -> Array:
    direction: Array = np.sign(b - a)  # [2]
    return direction


def _across(cell: Array, direction: Array, reach: int) -> tuple[slice, slice]:
    """The cells beside `cell`, at right angles to `direction`, up to `reach` to each side."""
    side = reach * direction[::-1]
    return _box(cell - side, cell + side, 0)


def _box(a: Array, b: Array, grow: int) -> tuple[slice, slice]:
    """The rectangle between two cells, grown to all sides."""
    low, high = np.minimum(a, b) - grow, np.maximum(a, b) + grow + 1
    return slice(int(low[0]), int(high[0])), slice(int(low[1]), int(high[1]))


def _cell(a: Array) -> Cell:
    return int(a[0]), int(a[1])
