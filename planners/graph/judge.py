"""Right and wrong on a graph: every first step of a shortest known way to the goal or to a nearest node not visited."""

from pkgutil import resolve_name
from typing import TYPE_CHECKING

import numpy as np

from fogbench.planners.graph.search import nearest
from fogbench.planners.judging import NOT_JUDGED, Verdict
from fogbench.worlds.graph.known import KnownGraph
from fogbench.worlds.types import Array, Observation, Task

if TYPE_CHECKING:
    from fogbench.planners.teachers import Teachers


class GraphJudge:
    """Follows one agent's known graph.

    A decision is judged while the goal, or a node that was not visited, is known. It is *wrong* when no shortest way
    there begins with it, and *strictly wrong* when the reference, `nearest_unvisited`, would decide otherwise.
    """

    place = -1

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.goal: int = task.goal
        self.known = KnownGraph(task.extent)

    @classmethod
    def side_by_side(cls, slots: int, *, hindsight: bool) -> "Teachers":
        """Teachers of so many episodes; they are named by a string, for no episode depends on them."""
        del hindsight  # there is none on graphs
        made: Teachers = resolve_name("fogbench.planners.graph.teachers:GraphTeachers")(slots)
        return made

    def see(self, observation: Observation) -> None:
        """Write what the agent sees into the known graph."""
        self.known.update(observation)
        self.place = observation.place

    def targets(self) -> Array:
        """Which nodes are right: [N] bool."""
        right = np.zeros(len(self.known.heads), np.bool_)
        right[self._steps()] = True
        return right

    def judge(self, action: int) -> Verdict:
        """The verdict on a node to go to."""
        steps = self._steps()
        if not len(steps):
            return NOT_JUDGED
        return Verdict(judged=True, wrong=action not in steps, strictly_wrong=action != steps[0])

    def _steps(self) -> Array:
        return nearest(*self.known.arrays, self.place, self.goal)[0]
