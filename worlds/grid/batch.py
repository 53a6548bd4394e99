"""Many grids in one call: the episodes of `GridWorld`, as arrays, by its own kernels.

Words used here
    B, n     slots, and those that a call is about
    H, W     of the largest map so far; beyond a smaller one everything is blocked, as outside of any map
    K        side of the widest view of a call; around a smaller one everything is UNKNOWN
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fogbench.worlds.batch import Luck, Steps
from fogbench.worlds.grid.moving import go, slip
from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.cells import enlarged
from fogbench.worlds.maps.sight import look, misread
from fogbench.worlds.types import UNKNOWN, Array, Move, Observation

if TYPE_CHECKING:
    from fogbench.worlds.grid.world import GridWorld


@dataclass(frozen=True, eq=False)
class GridObservations(Sequence[Observation]):
    """What n agents are told, as arrays, and one by one."""

    steps: Array
    """[n] int64"""
    places: Array
    """[n, 2] int64"""
    views: Array
    """[n, K, K] uint8, read-only"""
    blocked: Array
    """[n] bool"""
    radii: Array
    """[n] int64"""

    def __len__(self) -> int:
        """How many they are."""
        return len(self.places)

    def __getitem__(self, k: Any) -> Any:
        """That of one agent."""
        rim = self.views.shape[1] // 2 - self.radii[k]
        view = self.views[k, rim : self.views.shape[1] - rim, rim : self.views.shape[2] - rim]
        row, column = self.places[k].tolist()
        return Observation(int(self.steps[k]), (row, column), view, bool(self.blocked[k]))


class GridBatch:
    """Grid worlds side by side."""

    def __init__(self, slots: int) -> None:
        """No episode yet."""
        self.blocked = np.ones((slots, 1, 1), np.bool_)  # [B, H, W]
        self.posts = np.zeros((slots, 1, 1), np.bool_)  # [B, H, W], cells that witness
        self.places, self.goals = (np.zeros((slots, 2), np.int64) for _ in range(2))
        self.steps, self.budgets, self.radii = (np.zeros(slots, np.int64) for _ in range(3))
        self.stopped, self.witnessed, self.occluded, self.fails = (np.zeros(slots, np.bool_) for _ in range(4))
        self.false_readings, self.slip = (np.zeros(slots) for _ in range(2))
        self.worlds: list[Any] = [None] * slots
        self.lucks: list[Any] = [None] * slots  # of those that need any

    def reset(self, slots: Array, worlds: "Sequence[GridWorld]", lucks: Sequence[Luck]) -> None:
        """Put fresh episodes into some slots."""
        extents = np.array([world.blocked.shape for world in worlds])
        height, width = extents.max(0).tolist()
        self.blocked = enlarged(self.blocked, (height, width), 1)
        self.posts = enlarged(self.posts, (height, width), 0)
        self.blocked[slots], self.posts[slots] = True, False
        self.steps[slots], self.stopped[slots] = 0, False
        self.places[slots] = [world.start for world in worlds]
        self.goals[slots] = [world.task.goal for world in worlds]
        self.budgets[slots] = [world.task.budget.steps for world in worlds]
        for slot, world, luck in zip(slots.tolist(), worlds, lucks, strict=True):
            self._put(slot, world, luck)

    def _put(self, slot: int, world: "GridWorld", luck: Luck) -> None:
        sensor, rules, (height, width) = world.task.sensor, world.rules, world.blocked.shape
        self.blocked[slot, :height, :width] = world.blocked
        for post in world.posts:
            self.posts[(slot, *post)] = True
        self.radii[slot], self.occluded[slot] = sensor.radius, sensor.occlusion
        self.witnessed[slot], self.fails[slot] = world.reset().witnessed, rules.collision == "fails"
        self.false_readings[slot], self.slip[slot] = sensor.false_readings, rules.slip
        self.worlds[slot], self.lucks[slot] = world, luck() if sensor.false_readings or rules.slip else None

    def sense(self, slots: Array) -> GridObservations:
        """What the agents there are told."""
        radii, places = self.radii[slots], self.places[slots]
        side = 2 * int(radii.max()) + 1
        views = np.full((len(slots), side, side), UNKNOWN, np.uint8)
        look_each(self.blocked, slots, places, radii, self.occluded, views)
        for k in np.flatnonzero(self.false_readings[slots]).tolist():
            rim, wrong = side // 2 - radii[k], self.lucks[slots[k]].random((2 * radii[k] + 1,) * 2)
            own = views[k, rim : side - rim, rim : side - rim]
            own[:] = misread(own, wrong < self.false_readings[slots[k]])
        views.setflags(write=False)
        return GridObservations(self.steps[slots], places, views[:], self.stopped[slots], radii)

    def step(self, slots: Array, actions: Sequence[Any] | Array) -> Steps:
        """Move, or slip, or run into obstacles.

        Raises:
            TypeError: an action is none of the four moves.
        """
        moves = np.array(actions, np.int64)  # [n], and -1 for one that stays
        if ((moves < 0) | (moves >= len(Move))).any():
            raise TypeError(f"got the moves {sorted(set(moves.tolist()))}; expected numbers from 0 to {len(Move) - 1}")
        slipped = np.zeros(len(slots), np.bool_)
        for k in np.flatnonzero(self.slip[slots]).tolist():
            moved, slipped[k] = slip(self.worlds[slots[k]].rules, Move(moves[k]), self.lucks[slots[k]])
            moves[k] = -1 if moved is None else moved
        moved_on, reached = np.empty(len(slots), np.bool_), np.empty(len(slots), np.bool_)
        go_each(
            self.blocked, self.posts, self.goals, slots, moves,
            self.places, self.stopped, self.witnessed, moved_on, reached,
        )  # fmt: skip
        self.steps[slots] += 1
        collided = self.stopped[slots] & ~slipped & self.fails[slots]
        return Steps(moved_on.astype(np.float64), collided, reached, self.steps[slots] >= self.budgets[slots])


@kernel
def look_each(blocked: Array, slots: Array, places: Array, radii: Array, occluded: Array, views: Array) -> None:
    """Write true views into the middle of `views` [n, K, K], from `places` [n, 2] with `radii` [n]."""
    side = views.shape[1]
    for k in range(len(slots)):
        rim = side // 2 - radii[k]
        view = look(blocked[slots[k]], places[k, 0], places[k, 1], radii[k], occluded[slots[k]])
        views[k, rim : side - rim, rim : side - rim] = view


@kernel
def go_each(
    blocked: Array, posts: Array, goals: Array, slots: Array, moves: Array,
    places: Array, stopped: Array, witnessed: Array, moved_on: Array, reached: Array,
) -> None:  # fmt: skip
    """Move the agents of some slots; of `moves` [n], -1 stays."""
    for k in range(len(slots)):
        slot = slots[k]
        row, column = places[slot, 0], places[slot, 1]
        r, c, stop = go(blocked[slot], row, column, moves[k]) if moves[k] >= 0 else (row, column, False)
        places[slot, 0], places[slot, 1], stopped[slot] = r, c, stop
        witnessed[slot] |= posts[slot, r, c]
        moved_on[k] = r != row or c != column
        reached[k] = witnessed[slot] and r == goals[slot, 0] and c == goals[slot, 1]
