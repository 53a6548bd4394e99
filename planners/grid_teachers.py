"""Right and wrong on many grids in one call: the targets of `GridJudge`, by its own kernels.

Words used here
    B, n      slots, and those that a call is about
    H, W      of the largest map so far; of each slot only its own part counts
"""

from collections.abc import Sequence

import numpy as np

from fogbench.planners.optimal import matters, optimal
from fogbench.worlds.grid.batch import GridObservations
from fogbench.worlds.grid.world import GridWorld, to_goal
from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.cells import enlarged, fuse
from fogbench.worlds.maps.distances import FAR, nearer
from fogbench.worlds.types import Array


class GridTeachers:
    """Follow the known maps of episodes side by side; with hindsight they also know the worlds."""

    def __init__(self, slots: int, *, hindsight: bool) -> None:
        """Nobody yet."""
        self.known = np.zeros((slots, 1, 1), np.uint8)  # [B, H, W]
        self.distance = np.full((slots, 1, 1), FAR, np.int32)  # [B, H, W], as in `OptimalMoves`
        self.full = np.full((slots if hindsight else 0, 1, 1), FAR, np.int32)  # [B, H, W], on the full maps
        self.extents, self.goals, self.places = (np.zeros((slots, 2), np.int64) for _ in range(3))
        self.settled = np.full(slots, -1, np.int64)

    def reset(self, slots: Array, worlds: Sequence[GridWorld]) -> None:
        """Nothing is known yet of some worlds."""
        self.extents[slots] = [world.blocked.shape for world in worlds]
        self.goals[slots] = [world.task.goal for world in worlds]
        height, width = self.extents[slots].max(0).tolist()
        self.known = enlarged(self.known, (height, width), 0)
        self.distance = enlarged(self.distance, (height, width), FAR)
        self.known[slots], self.distance[slots], self.settled[slots] = 0, FAR, -1
        if len(self.full):
            self.full = enlarged(self.full, (height, width), FAR)
            for slot, world in zip(slots.tolist(), worlds, strict=True):
                self.full[slot, : world.blocked.shape[0], : world.blocked.shape[1]] = to_goal(world)

    def see(self, slots: Array, observations: GridObservations) -> None:
        """Write what the agents see into the known maps."""
        self.places[slots] = observations.places
        see_each(slots, self.extents, observations.views, self.places, self.known, self.distance, self.settled)

    def targets(self, slots: Array) -> Array:
        """Which moves are right: [n, 4] bool."""
        told = np.empty((len(slots), 4), np.bool_)
        teach_each(
            slots, self.extents, self.goals, self.places, self.known, self.distance, self.settled, self.full, told
        )
        return told


@kernel
def see_each(
    slots: Array, extents: Array, views: Array, places: Array, known: Array, distance: Array, settled: Array
) -> None:
    """Write views into known maps, and note what no longer holds of their distances."""
    for k in range(len(slots)):
        slot = slots[k]
        height, width = extents[slot]
        own, far = known[slot, :height, :width], distance[slot, :height, :width]
        touched = fuse(own, views[k], places[slot, 0], places[slot, 1])
        if len(touched) and matters(own, touched, far, settled[slot]):
            settled[slot] = -1


@kernel
def teach_each(
    slots: Array, extents: Array, goals: Array, places: Array,
    known: Array, distance: Array, settled: Array, full: Array, told: Array,
) -> None:  # fmt: skip
    """Tell which moves are right; of these, those that turn out to be, where there are full distances and any does."""
    for k in range(len(slots)):
        slot = slots[k]
        height, width = extents[slot]
        place, goal = (places[slot, 0], places[slot, 1]), (goals[slot, 0], goals[slot, 1])
        own, far = known[slot, :height, :width], distance[slot, :height, :width]
        settled[slot], right = optimal(own, goal, place, far, settled[slot])
        if len(full):
            best = right & nearer(full[slot, :height, :width], place)
            right = best if best.any() else right
        told[k] = right
