"""Right and wrong on a grid: every move that begins a shortest path on the agent's own known map is right."""

from fogbench.planners.astar import AStarAgent
from fogbench.planners.judging import NOT_JUDGED, Verdict
from fogbench.planners.optimal import OptimalMoves, nearer
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.maps.distances import distances
from fogbench.worlds.types import Array, Move, Observation, Task


class GridJudge:
    """Follows one agent's known map."""

    observation: Observation
    """The last one."""

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.known = KnownMap(task.extent)
        self.optimal = OptimalMoves(task)
        self.reference = AStarAgent(task, eager=False)

    @classmethod
    def hindsight(cls, world: GridWorld) -> "Hindsight":
        """One that also knows the world."""
        return Hindsight(world)

    def see(self, observation: Observation) -> None:
        """Write what the agent sees into the known map."""
        self.observation = observation
        self.known.update(observation)
        self.right: Array = self.optimal.update(self.known.cells, observation.place, len(observation.view) // 2)

    def targets(self) -> Array:
        """Which moves are right: [4] bool."""
        return self.right

    def judge(self, action: Move) -> Verdict:
        """The verdict on a move."""
        expected = self.reference.act(self.observation)
        if not self.right.any():
            return NOT_JUDGED
        return Verdict(judged=True, wrong=not self.right[action], strictly_wrong=action is not expected)


class Hindsight(GridJudge):
    """Of the moves that are right by what is known, those count that turn out to be, if any does."""

    def __init__(self, world: GridWorld) -> None:
        """Nothing is known yet of the world by the agent."""
        super().__init__(world.task)
        self.world = world
        self.distance = distances(world.blocked, world.task.goal, (-1, -1))  # [H, W], on the full map

    def targets(self) -> Array:
        """Which moves count: [4] bool."""
        right = super().targets()
        place, goal = self.observation.place, self.world.task.goal
        best: Array = right & nearer(self.world.blocked, self.distance, place, goal)
        return best if best.any() else right
