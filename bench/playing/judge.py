"""Was a decision right, by what the agent itself had seen? Computed beside the loop, never timed."""

import numpy as np

from planners.astar import AStarAgent
from worlds.belief import passable
from worlds.distances import FAR, distances
from worlds.kernel import kernel
from worlds.types import BLOCKED, Array, Cell, Move, Observation, Task


class GridJudge:
    """Follows one agent's known map and counts its wrong decisions.

    A decision is judged while the known map, unknown counted as free, has a path to the goal, and the agent is not
    there yet (a tunnel's goal may not count yet). It is *wrong* when no shortest path there begins with it, and
    *strictly wrong* when A* would decide otherwise.
    """

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.goal: Cell = task.goal
        self.reference = AStarAgent(task, eager=False)
        self.blocked: Array = np.zeros(self.reference.known.cells.shape, np.bool_)  # [H, W], where known to be
        self.distance: Array = np.full(self.blocked.shape, FAR, np.int32)  # [H, W], from the goal
        self.settled = -1  # distances up to this one are known for all cells
        self.judged = 0
        self.wrong = 0
        self.strict_wrong = 0

    def see(self, observation: Observation, move: Move) -> None:
        """Judge the decision `move`, taken on `observation`."""
        reference = self.reference.act(observation)
        left = self._left(observation)
        if left in {0, FAR} or self.blocked[self.goal]:
            return
        self.judged += 1
        self.strict_wrong += move is not reference
        down, right = move.delta
        ahead = (observation.place[0] + down, observation.place[1] + right)
        self.wrong += not (passable(self.blocked, *ahead) and self.distance[ahead] == left - 1)

    def _left(self, observation: Observation) -> int:
        """The agent's distance from the goal; all distances up to this one are brought up to date."""
        known, place = self.reference.known.cells, observation.place
        changed = _copy_walls(known, place, len(observation.view) // 2, self.blocked)
        if changed or self.distance[place] > self.settled:
            self.distance = distances(self.blocked, self.goal, place)
            self.settled = int(self.distance[place])
        return int(self.distance[place])


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
