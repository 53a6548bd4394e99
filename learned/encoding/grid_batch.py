"""What a network sees of many grids in one call: the viewpoints of `GridEncoding`, as arrays.

Words used here
    B, n    slots, and those that a call is about
"""

from collections.abc import Sequence

import numpy as np

from fogbench.learned.encoding.grid_inputs import STILL, Inputs, Known, encode
from fogbench.learned.encoding.grid_sizes import Frame
from fogbench.worlds.grid.batch import GridObservations
from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.cells import enlarged, fuse
from fogbench.worlds.types import BLOCKED, UNKNOWN, Array, Task


class GridViewpoints:
    """Goals, last moves and, if they are shown, known maps of episodes side by side."""

    observations: GridObservations
    """Those that no move has followed yet."""

    def __init__(self, slots: int, frame: Frame, *, stitched: bool) -> None:
        """Nobody yet."""
        self.frame = frame
        self.goals, self.extents = (np.zeros((slots, 2), np.int64) for _ in range(2))
        self.moves = np.full(slots, STILL, np.int64)
        self.known = np.zeros((slots if stitched else 0, 3, 3), np.uint8)  # [B, H + 2, W + 2], each map with a rim

    def reset(self, slots: Array, tasks: Sequence[Task]) -> None:
        """Nothing is seen yet of some tasks.

        Raises:
            Mistake: a network that was made for maps of one size meets another.
        """
        for task in tasks:
            self.frame.check(task.extent)
        self.goals[slots], self.moves[slots] = [task.goal for task in tasks], STILL
        self.extents[slots] = [task.extent for task in tasks]
        if len(self.known):
            height, width = (self.extents[slots].max(0) + 2).tolist()
            self.known = enlarged(self.known, (height, width), UNKNOWN)
            self.known[slots] = UNKNOWN
            clear_each(slots, self.extents, self.known)

    def see(self, slots: Array, observations: GridObservations) -> None:
        """Look."""
        self.observations = observations
        if len(self.known):
            fuse_each(slots, self.extents, observations.views, observations.places, self.known)

    def encode(self, slots: Array) -> Inputs:
        """What a network sees after the last look at just these slots."""
        places, views = self.observations.places, self.observations.views
        cells, corners = views, places - views.shape[1] // 2
        if len(self.known):
            cells, corners = self.known[slots], np.full_like(places, -1)
        known = Known(cells, corners, places, self.goals[slots], self.moves[slots], self.observations.blocked)
        return encode(known, self.frame)

    def act(self, slots: Array, outputs: Array) -> Array:
        """The moves are the outputs."""
        self.moves[slots] = outputs
        return outputs


@kernel
def clear_each(slots: Array, extents: Array, known: Array) -> None:
    """Nothing is known of some maps but that all around them is blocked, as in a view."""
    for slot in slots:
        height, width = extents[slot]
        known[slot, : height + 2, : width + 2] = BLOCKED
        known[slot, 1 : height + 1, 1 : width + 1] = UNKNOWN


@kernel
def fuse_each(slots: Array, extents: Array, views: Array, places: Array, known: Array) -> None:
    """Write views [n, K, K] from `places` [n, 2] into known maps with rims."""
    for k in range(len(slots)):
        height, width = extents[slots[k]]
        own = known[slots[k], 1 : height + 1, 1 : width + 1]
        fuse(own, views[k], places[k, 0], places[k, 1])
