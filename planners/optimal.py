"""Which moves are optimal on a known map: what decisions are judged by, and what networks are taught."""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.distances import FAR, distances
from fogbench.worlds.types import BLOCKED, DELTAS, Array, Cell, Task


class OptimalMoves:
    """Every move that begins a shortest path to the goal of a task, unknown cells counted as free.

    Distances from the goal are kept from one decision to the next, until a wall appears or goes.
    """

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.goal: Cell = task.goal
        self.blocked: Array = np.zeros((int(task.extent[0]), int(task.extent[1])), np.bool_)  # [H, W], known to be
        self.distance: Array = np.full(self.blocked.shape, FAR, np.int32)  # [H, W], from the goal
        self.settled = -1  # distances up to this one are known for all cells

    def update(self, known: Array, place: Cell, reach: int) -> Array:
        """The optimal moves from `place`, after a look that may have changed the map around it.

        Args:
            known: [H, W] uint8 of UNKNOWN, FREE, BLOCKED.
            place: where the agent is.
            reach: cells to each side that the sensor shows.

        Returns:
            [4] bool; none where no path leads to the goal, or none is needed.
        """
        changed = _copy_walls(known, place, reach, self.blocked)
        if changed or self.distance[place] > self.settled:
            self.distance = distances(self.blocked, self.goal, place)
            self.settled = int(self.distance[place])
        return nearer(self.blocked, self.distance, place, self.goal)


@kernel
def _copy_walls(known: Array, place: Cell, reach: int, blocked: Array) -> bool:
    """Write which of the cells in view from `place` are known to be blocked; whether that changed anything."""
    changed = False
    for r in range(max(0, place[0] - reach), min(known.shape[0], place[0] + reach + 1)):
        for c in range(max(0, place[1] - reach), min(known.shape[1], place[1] + reach + 1)):
            wall = known[r, c] == BLOCKED
            changed |= wall != blocked[r, c]
            blocked[r, c] = wall
    return changed


@kernel
def nearer(blocked: Array, distance: Array, place: Cell, goal: Cell) -> Array:
    """Which of the four neighbours are nearer to the goal than `place`: [4] bool; none if there is no way to it.

    Args:
        blocked: [H, W] bool.
        distance: [H, W] int32 from the goal, as `fogbench.worlds.maps.distances.distances` tells it.
        place: where the agent is.
        goal: where it should be.
    """
    found = np.zeros(4, np.bool_)
    if distance[place] == FAR or blocked[goal]:
        return found
    for move in range(4):
        r, c = place[0] + DELTAS[move][0], place[1] + DELTAS[move][1]
        inside = 0 <= r < distance.shape[0] and 0 <= c < distance.shape[1]
        found[move] = inside and distance[r, c] == distance[place] - 1  # a blocked cell is FAR
    return found
