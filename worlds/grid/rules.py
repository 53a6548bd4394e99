"""What a grid's sensor shows, and what happens when a move fails."""

from typing import Literal

from fogbench.worlds.settings import Positive, Probability, Settings


class SquareView(Settings):
    """A sensor that shows the square of cells around the agent; outside the map everything is blocked."""

    radius: Positive = 3
    """Cells to each side; the view is `2 * radius + 1` wide."""
    occlusion: bool = False
    """Whether blocked cells hide what lies behind them."""
    false_readings: Probability = 0.0
    """Probability that a seen cell reads free for blocked or blocked for free, drawn afresh at every look."""


class GridRules(Settings):
    """What happens when a move fails."""

    collision: Literal["fails", "blocked"] = "fails"
    """A move into an obstacle ends the episode (`fails`) or leaves the agent where it is (`blocked`)."""
    slip: Probability = 0.0
    """Probability that a move does not do what it should; slipping into an obstacle is no collision."""
    slip_to: Literal["stay", "sideways"] = "stay"
    """Where a slip leads: nowhere, or a quarter turn to either side."""
