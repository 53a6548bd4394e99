"""Many known graphs side by side, as arrays: the graphs of `KnownGraph`, by its own kernels.

Words used here
    B, n      slots, and those that a call is about
    N         nodes of the largest graph so far; a smaller one has none of the others
"""

from collections.abc import Sequence

import numpy as np

from fogbench.worlds.graph.batch import GraphObservations, widened
from fogbench.worlds.graph.known import NONE, fuse
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array, Task


class KnownGraphs:
    """What the agents of some episodes have seen."""

    def __init__(self, slots: int) -> None:
        """Nobody yet."""
        self.visited = np.zeros((slots, 0), np.bool_)  # [B, N]
        self.heads = np.full((slots, 0), NONE, np.int32)  # [B, N]
        self.links = np.zeros((slots, 0, 2), np.int32)
        self.lengths = np.zeros((slots, 0))
        self.used, self.places, self.goals = (np.zeros(slots, np.int64) for _ in range(3))

    def reset(self, slots: Array, tasks: Sequence[Task]) -> None:
        """Nothing is known yet of some tasks."""
        size = max(int(task.extent[0]) for task in tasks)
        self.visited, self.heads = widened(self.visited, size), widened(self.heads, size)
        self.visited[slots], self.heads[slots], self.used[slots] = False, NONE, 0
        self.goals[slots] = [task.goal for task in tasks]

    def see(self, slots: Array, observations: GraphObservations) -> None:
        """Write what the agents see into the known graphs."""
        self.places[slots] = observations.places
        most = int(self.used[slots].max() + 2 * np.isfinite(observations.views[:, :, 0]).sum(1).max())
        if most > self.links.shape[1]:
            room = max(most, 2 * self.links.shape[1])
            self.links, self.lengths = widened(self.links, room), widened(self.lengths, room)
        see_each(slots, observations.views, self.places, self.visited, self.heads, self.links, self.lengths, self.used)


@kernel
def see_each(
    slots: Array, views: Array, places: Array, visited: Array, heads: Array, links: Array, lengths: Array, used: Array
) -> None:  # fmt: skip
    """Write views [n, N, C] into the known graphs of nodes that were not visited."""
    for k in range(len(slots)):
        slot = slots[k]
        if not visited[slot, places[slot]]:
            known = visited[slot], heads[slot], links[slot], lengths[slot]
            used[slot] = fuse(*known, used[slot], places[slot], views[k])
