"""The grid world: a map of free and blocked cells, four moves, a square view."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fogbench.worlds.grid.moving import go, slip
from fogbench.worlds.grid.rules import GridRules, SquareView
from fogbench.worlds.maps.cells import KnownMap, manhattan
from fogbench.worlds.maps.covariates import covariates
from fogbench.worlds.maps.distances import distances
from fogbench.worlds.maps.sight import look, misread
from fogbench.worlds.picture import Cells, Picture, Squares
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array, Cell, Move, Observation, Step, Task

if TYPE_CHECKING:
    from fogbench.worlds.batch import Batch


class GridState(NamedTuple):
    """Where an episode stands."""

    step: int
    place: Cell
    blocked: bool
    """Whether an obstacle stopped the last move."""
    witnessed: bool
    """Whether one of the world's posts was visited, or it has none."""


@dataclass(frozen=True, eq=False)
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

    @classmethod
    def side_by_side(cls, slots: int) -> "Batch":
        """A batch of such worlds; it is named by a string, for no episode depends on it."""
        batch: Batch = resolve_name("fogbench.worlds.grid.batch:GridBatch")(slots)
        return batch

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
        move, slipped = slip(self.rules, action, rng)
        place, stopped = state.place, False
        if move is not None:
            row, column, stopped = go(self.blocked, *place, move.value)
            place = row, column
        witnessed = state.witnessed or self._witnesses(place)
        length = float(place != state.place)
        collided = stopped and not slipped and self.rules.collision == "fails"
        reached = witnessed and place == self.task.goal
        return Step(GridState(state.step + 1, place, stopped, witnessed), length, collided, reached)

    def shortest(self) -> float:
        """Length of the optimal path on the full map [cells]; a tunnel's end wall need not be seen on it."""
        return float(self.optimum)

    def straight(self) -> float:
        """Manhattan distance from start to goal [cells]."""
        return float(manhattan(self.start, self.task.goal))

    def covariates(self) -> Mapping[str, float]:
        """Density, detour, dead ends and openness; see `fogbench.worlds.maps.covariates`."""
        return covariates(self.blocked, self.straight(), self.optimum)

    def remaining(self, state: GridState) -> float:
        """Length of the optimal path from here on the full map [cells]."""
        return float(to_goal(self)[state.place])

    def known(self) -> KnownMap:
        """The map of an agent that has seen nothing."""
        return KnownMap(self.task.extent)

    def action(self, *numbers: float) -> Move:
        """The move of a recorded number."""
        (number,) = numbers
        return Move(int(number))

    def picture(self, known: KnownMap, observation: Observation, path: Sequence[Cell]) -> Picture:
        """A moment in cells: the cells that the sensor shows, those visited, the agent's and the goal's."""
        view = observation.view
        seen = np.argwhere(view != UNKNOWN) + observation.place - len(view) // 2  # [n, 2]
        inside = ((seen >= 0) & (seen < self.blocked.shape)).all(1)
        return Picture(
            extent=(float(self.blocked.shape[0]), float(self.blocked.shape[1])),
            truth=(Cells(np.where(self.blocked, BLOCKED, FREE).astype(np.uint8)),),
            known=(Cells(known.cells.copy()),),
            view=Squares(seen[inside]),
            path=Squares(np.array(path)),
            agent=Squares(np.array([observation.place])),
            goal=Squares(np.array([self.task.goal])),
        )

    def _witnesses(self, place: Cell) -> bool:
        return not self.posts or place in self.posts


@lru_cache(maxsize=4)
def to_goal(world: GridWorld) -> Array:
    """[H, W] int32, distances to the goal on the full map; those of the last few worlds are kept."""
    return distances(world.blocked, world.task.goal, (-1, -1))
