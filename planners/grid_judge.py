"""Right and wrong on a grid: every move that begins a shortest path on the agent's own known map is right."""

from pkgutil import resolve_name
from typing import TYPE_CHECKING

from fogbench.planners.astar import AStarAgent
from fogbench.planners.judging import Verdict
from fogbench.planners.optimal import OptimalMoves
from fogbench.worlds.grid.world import GridWorld, to_goal
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.maps.distances import nearer
from fogbench.worlds.types import Array, Move, Observation, Task

if TYPE_CHECKING:
    from fogbench.planners.teachers import Teachers


class GridJudge:
    """Follows one agent's known map.

    A decision is judged while the known map, unknown counted as free, has a path to the goal, and the agent is not
    there yet (a tunnel's goal may not count yet). It is *wrong* when no shortest path there begins with it, and
    *strictly wrong* when A* would decide otherwise.
    """

    observation: Observation
    """The last one."""

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.known = KnownMap(task.extent)
        self.optimal = OptimalMoves(task.goal, self.known.cells)
        self.reference = AStarAgent(task, eager=False, known=self.known)

    @classmethod
    def hindsight(cls, world: GridWorld) -> "Hindsight":
        """One that also knows the world."""
        return Hindsight(world)

    @classmethod
    def side_by_side(cls, slots: int, *, hindsight: bool) -> "Teachers":
        """Teachers of so many episodes; they are named by a string, for no episode depends on them."""
        made: Teachers = resolve_name("fogbench.planners.grid_teachers:GridTeachers")(slots, hindsight=hindsight)
        return made

    def see(self, observation: Observation) -> None:
        """Write what the agent sees into the known map."""
        self.observation = observation
        self.optimal.see(self.known.update(observation))

    def targets(self) -> Array:
        """Which moves are right: [4] bool."""
        return self.optimal.moves(self.observation.place)

    def judge(self, action: Move) -> Verdict:
        """The verdict on a move; once for every observation, since the reference follows its path."""
        expected = self.reference.follow(self.observation)
        right: list[bool] = self.optimal.moves(self.observation.place).tolist()
        judged = any(right)
        return Verdict(judged, judged and not right[action], judged and action is not expected)


class Hindsight(GridJudge):
    """Of the moves that are right by what is known, those count that turn out to be, if any does.

    Which of equals turns out better depends on what lies out of sight; over many maps it tells where walls are likely.
    """

    def __init__(self, world: GridWorld) -> None:
        """Nothing is known yet of the world by the agent."""
        super().__init__(world.task)
        self.distance = to_goal(world)  # [H, W], on the full map

    def targets(self) -> Array:
        """Which moves count: [4] bool."""
        right = super().targets()
        best: Array = right & nearer(self.distance, self.observation.place)
        return best if best.any() else right
