"""Right and wrong on many graphs in one call: the targets of `GraphJudge`, by its own kernels.

Words used here
    B, n      slots, and those that a call is about
    N         nodes of the largest graph so far; a smaller one has none of the others
"""

from collections.abc import Sequence

import numpy as np

from fogbench.planners.graph_search import nearest
from fogbench.worlds.graph.batch import GraphObservations, widened
from fogbench.worlds.graph.known import NONE, fuse
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array


class GraphTeachers:
    """Follow the known graphs of episodes side by side."""

    def __init__(self, slots: int) -> None:
        """Nobody yet."""
        self.visited = np.zeros((slots, 0), np.bool_)  # [B, N]
        self.heads = np.full((slots, 0), NONE, np.int32)  # [B, N]
        self.links = np.zeros((slots, 0, 2), np.int32)
        self.lengths = np.zeros((slots, 0))
        self.used, self.places, self.goals = (np.zeros(slots, np.int64) for _ in range(3))

    def reset(self, slots: Array, worlds: Sequence[GraphWorld]) -> None:
        """Nothing is known yet of some worlds."""
        size, ends = max(world.graph.size for world in worlds), max(len(world.graph.ends) for world in worlds)
        self.visited, self.heads = widened(self.visited, size), widened(self.heads, size)
        self.links, self.lengths = widened(self.links, ends), widened(self.lengths, ends)
        self.visited[slots], self.heads[slots], self.used[slots] = False, NONE, 0
        self.goals[slots] = [world.task.goal for world in worlds]

    def see(self, slots: Array, observations: GraphObservations) -> None:
        """Write what the agents see into the known graphs."""
        self.places[slots] = observations.places
        see_each(slots, observations.views, self.places, self.visited, self.heads, self.links, self.lengths, self.used)

    def targets(self, slots: Array) -> Array:
        """Which nodes are right: [n, N] bool."""
        told = np.zeros((len(slots), self.heads.shape[1]), np.bool_)
        teach_each(slots, self.visited, self.heads, self.links, self.lengths, self.places, self.goals, told)
        return told


@kernel
def see_each(
    slots: Array, views: Array, places: Array, visited: Array, heads: Array, links: Array, lengths: Array, used: Array
) -> None:  # fmt: skip
    """Write the rows of views [n, N, C] into the known graphs of nodes that were not visited."""
    for k in range(len(slots)):
        slot = slots[k]
        if not visited[slot, places[slot]]:
            known = visited[slot], heads[slot], links[slot], lengths[slot]
            used[slot] = fuse(*known, used[slot], places[slot], views[k, :, 0])


@kernel
def teach_each(
    slots: Array, visited: Array, heads: Array, links: Array, lengths: Array, places: Array, goals: Array, told: Array
) -> None:  # fmt: skip
    """Tell which nodes are right."""
    for k in range(len(slots)):
        slot = slots[k]
        known = visited[slot], heads[slot], links[slot], lengths[slot]
        for node in nearest(*known, places[slot], goals[slot])[0]:
            told[k, node] = True
