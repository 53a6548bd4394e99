"""Rooms: a square cut into rooms by walls with doors."""

from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from fogbench.worlds.maps.layout import CellConditions, Layout, SquareMaps
from fogbench.worlds.maps.split import split
from fogbench.worlds.settings import SIDE, PositiveRange, Range
from fogbench.worlds.types import Array


class Rooms(SquareMaps):
    """Rows and columns of rooms, walls one cell thick, doors one cell wide.

    No room is less than half as wide as if all were equal.
    """

    size: Annotated[int, Field(ge=2, le=SIDE)]
    """Side of the square map [cells]."""
    rooms: PositiveRange
    """How many rooms there are in a row, and how many in a column, each drawn uniformly."""
    doors: Range
    """How many doors two neighbouring rooms share, drawn uniformly for each pair; no more than their wall has cells."""

    @model_validator(mode="after")
    def _fits(self) -> "Rooms":
        least = 2 * self.rooms[1] - 1
        if self.size < least:
            raise ValueError(f"a size from {least}, for {self.rooms[1]} rooms in a row")
        return self

    def draw(self, rng: np.random.Generator, conditions: CellConditions) -> Layout:
        """Rooms without a task."""
        del conditions
        blocked = np.zeros((self.size, self.size), np.bool_)  # [H, W]
        rows, columns = self._sides(rng), self._sides(rng)
        blocked[[side.stop for side in rows[:-1]]] = True
        blocked[:, [side.stop for side in columns[:-1]]] = True
        self._open(blocked, rows, columns, rng)
        self._open(blocked.T, columns, rows, rng)
        return Layout(blocked)

    def _sides(self, rng: np.random.Generator) -> list[range]:
        """Where the rooms of a row lie; a wall stands at the end of each but the last."""
        count = int(rng.integers(*self.rooms, endpoint=True))
        inside = self.size - (count - 1)
        widths = split(inside, count, max(1, inside // (2 * count)), rng)
        ends = np.cumsum(widths) + np.arange(count)
        return [range(end - width, end) for end, width in zip(ends.tolist(), widths, strict=True)]

    def _open(self, blocked: Array, rows: list[range], columns: list[range], rng: np.random.Generator) -> None:
        """Open doors in the walls at the right of the rooms."""
        for row in rows:
            for column in columns[:-1]:
                count = int(rng.integers(*self.doors, endpoint=True))
                doors = rng.choice(row, size=min(count, len(row)), replace=False)  # [count]
                blocked[doors, column.stop] = False
