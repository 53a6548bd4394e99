"""Was a decision right, by what the agent itself had seen? Computed beside the loop, never timed."""

from fogbench.planners.astar import AStarAgent
from fogbench.planners.optimal import OptimalMoves
from fogbench.worlds.types import Move, Observation, Task


class GridJudge:
    """Follows one agent's known map and counts its wrong decisions.

    A decision is judged while the known map, unknown counted as free, has a path to the goal, and the agent is not
    there yet (a tunnel's goal may not count yet). It is *wrong* when no shortest path there begins with it, and
    *strictly wrong* when A* would decide otherwise.
    """

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.reference = AStarAgent(task, eager=False)
        self.optimal = OptimalMoves(task)
        self.judged = 0
        self.wrong = 0
        self.strict_wrong = 0

    def see(self, observation: Observation, move: Move) -> None:
        """Judge the decision `move`, taken on `observation`."""
        reference = self.reference.act(observation)
        reach = len(observation.view) // 2
        right = self.optimal.update(self.reference.known.cells, observation.place, reach)  # [4]
        if right.any():
            self.judged += 1
            self.wrong += not right[move]
            self.strict_wrong += move is not reference
