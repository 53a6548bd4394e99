"""What a grid's sensor shows, and what happens when a move fails."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from fogbench.worlds.maps.sight import hidden
from fogbench.worlds.settings import Probability, Settings
from fogbench.worlds.types import Array, Cell


class SquareView(Settings):
    """A sensor that shows the square of cells around the agent; outside the map everything is blocked."""

    radius: Annotated[int, Field(ge=1, le=1024)] = 3
    """Cells to each side; the view is `2 * radius + 1` wide."""
    occlusion: bool = False
    """Whether blocked cells hide what lies behind them."""
    false_readings: Probability = 0.0
    """Probability that a seen cell reads free for blocked or blocked for free, drawn afresh at every look."""

    def shows(self, blocked: Array, cell: Cell, places: Array) -> Array:
        """From which of the cells in `places` [n, 2] it shows `cell` of a map [H, W]: [n] bool."""
        shown: Array = np.abs(places - cell).max(1, initial=0) <= self.radius
        for k in np.flatnonzero(shown).tolist() if self.occlusion else ():
            row, column = places[k].tolist()
            shown[k] = not hidden(blocked, row, column, cell[0] - row, cell[1] - column)
        return shown


class GridRules(Settings):
    """What happens when a move fails."""

    collision: Literal["fails", "blocked"] = "fails"
    """A move into an obstacle ends the episode (`fails`) or leaves the agent where it is (`blocked`)."""
    slip: Probability = 0.0
    """Probability that a move does not do what it should; slipping into an obstacle is no collision."""
    slip_to: Literal["stay", "sideways"] = "stay"
    """Where a slip leads: nowhere, or a quarter turn to either side."""
