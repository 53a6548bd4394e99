"""Which moves are optimal on a known map: what decisions are judged by, and what networks are taught."""

import numpy as np

from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.distances import FAR, distances, nearer
from fogbench.worlds.types import BLOCKED, DELTAS, Array, Cell


class OptimalMoves:
    """Every move that begins a shortest path to a goal, unknown cells counted as free.

    Distances from the goal are searched as far as the agent, and kept until a change of the known map touches them.
    """

    def __init__(self, goal: Cell, known: Array) -> None:
        """Follow a known map [H, W] uint8 of UNKNOWN, FREE, BLOCKED, which somebody else writes."""
        self.goal = goal
        self.known = known
        self.distance: Array = np.full(known.shape, FAR, np.int32)  # [H, W], from the goal
        self.settled = -1  # distances up to this one are those of the known map, for all cells

    def see(self, touched: Array) -> None:
        """Take note of the cells `touched` [n] (flat indices), whose reading has changed."""
        if len(touched) and matters(self.known, touched, self.distance, self.settled):
            self.settled = -1

    def moves(self, place: Cell) -> Array:
        """The optimal moves from a cell: [4] bool; none where no path leads to the goal, or none is needed."""
        self.settled, moves = optimal(self.known, self.goal, place, self.distance, self.settled)
        return moves


@kernel
def optimal(known: Array, goal: Cell, place: Cell, distance: Array, settled: int) -> tuple[int, Array]:
    """The optimal moves from a cell: [4] bool; before them, up to where `distance` is settled after that."""
    if distance[place] > settled:
        distance[:] = distances(known == BLOCKED, goal, place)
        settled = distance[place]
    if known[goal] == BLOCKED:
        return settled, np.zeros(len(DELTAS), np.bool_)
    return settled, nearer(distance, place)


@kernel
def matters(known: Array, touched: Array, distance: Array, settled: int) -> bool:
    """Whether a change of readings can change a distance of `settled` or less.

    A cell that is now blocked does if it had such a distance. A cell that is now free does if it had none although a
    neighbour is nearer than `settled`, for then it was blocked.
    """
    height, width = known.shape
    for flat in touched:
        r, c = flat // width, flat % width
        near = distance[r, c] <= settled and distance[r, c] != FAR
        if known[r, c] == BLOCKED:
            if near:
                return True
        elif not near:
            for down, right in DELTAS:
                i, j = r + down, c + right
                if 0 <= i < height and 0 <= j < width and distance[i, j] < settled:
                    return True
    return False
