"""The grid world: a map of free and blocked cells, four moves, a square view."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np

from worlds.belief import look, misread, passable
from worlds.conditions import BudgetSettings, Tasks
from worlds.covariates import covariates
from worlds.settings import Positive, Probability, Settings
from worlds.types import Array, Cell, Move, Observation, Step, Task


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


class GridConditions(Settings):
    """Everything in a scenario that is neither maps nor agents, for worlds of kind `grid`."""

    sensor: SquareView = SquareView()
    rules: GridRules = GridRules()
    tasks: Tasks = Tasks()
    budget: BudgetSettings


class GridState(NamedTuple):
    """Where an episode stands."""

    step: int
    place: Cell
    blocked: bool
    """Whether an obstacle stopped the last move."""
    witnessed: bool
    """Whether one of the world's posts was visited, or it has none."""


@dataclass(frozen=True, eq=False, slots=True)
class GridWorld:
    """One map with one task."""

    blocked: Array
    """[H, W] bool, read-only."""
    start: Cell
    task: Task
    rules: GridRules
    optimum: int
    posts: frozenset[Cell]
    """Cells of which one must be visited before the goal counts: in a tunnel, from where its end wall is seen."""

    def reset(self) -> GridState:
        """The state before the first decision."""
        return GridState(0, self.start, blocked=False, witnessed=self._witnesses(self.start))

    def sense(self, state: GridState, rng: np.random.Generator) -> Observation:
        """What the agent is told; with false readings, K * K numbers are drawn whatever the truth."""
        sensor: SquareView = self.task.sensor
        view = look(self.blocked, *state.place, sensor.radius, sensor.occlusion)
        if sensor.false_readings:
            view = misread(view, rng.random(view.shape) < sensor.false_readings)
        view.setflags(write=False)
        return Observation(state.step, state.place, view[:], state.blocked)  # who does not own it cannot unlock it

    def step(self, state: GridState, action: Any, rng: np.random.Generator) -> Step:
        """Move, or slip, or run into an obstacle.

        Raises:
            TypeError: `action` is not a `Move`.
        """
        if type(action) is not Move:
            raise TypeError(f"act returned {action!r} ({type(action).__name__}); expected a Move or None")
        move, slipped = self._slip(action, rng)
        place, stopped = state.place, False
        if move is not None:
            down, right = move.delta
            ahead = (place[0] + down, place[1] + right)
            stopped = not passable(self.blocked, *ahead)
            place = place if stopped else ahead
        witnessed = state.witnessed or self._witnesses(place)
        return Step(
            GridState(state.step + 1, place, stopped, witnessed),
            length=float(place != state.place),
            collided=stopped and not slipped and self.rules.collision == "fails",
            reached=witnessed and place == self.task.goal,
        )

    def shortest(self) -> float:
        """Length of the optimal path on the full map [cells]; a tunnel's end wall need not be seen on it."""
        return float(self.optimum)

    def straight(self) -> float:
        """Manhattan distance from start to goal [cells]."""
        return float(manhattan(self.start, self.task.goal))

    def covariates(self) -> Mapping[str, float]:
        """Density, detour, dead ends and openness; see `worlds.covariates`."""
        return covariates(self.blocked, self.straight(), self.optimum)

    def _slip(self, move: Move, rng: np.random.Generator) -> tuple[Move | None, bool]:
        if not self.rules.slip:
            return move, False
        slips, side = rng.random(2)  # always two numbers, so that the stream never shifts
        if slips >= self.rules.slip:
            return move, False
        if self.rules.slip_to == "stay":
            return None, True
        return Move((move + (1 if side < 0.5 else 3)) % 4), True

    def _witnesses(self, place: Cell) -> bool:
        return not self.posts or place in self.posts


def manhattan(a: Cell, b: Cell) -> int:
    """Length of the shortest path between two cells of an empty map [cells]."""
    return abs(a[0] - b[0]) + abs(a[1] - b[1])
