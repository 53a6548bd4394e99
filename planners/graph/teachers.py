"""Right and wrong on many graphs in one call: the targets of `GraphJudge`, by its own kernels.

Words used here
    B, n, N    as in `fogbench.worlds.graph.known_batch`
"""

from collections.abc import Sequence

import numpy as np

from fogbench.planners.graph.search import nearest
from fogbench.worlds.graph.batch import GraphObservations
from fogbench.worlds.graph.known_batch import KnownGraphs
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array


class GraphTeachers:
    """Follow the known graphs of episodes side by side."""

    def __init__(self, slots: int) -> None:
        """Nobody yet."""
        self.known = KnownGraphs(slots)

    def reset(self, slots: Array, worlds: Sequence[GraphWorld]) -> None:
        """Nothing is known yet of some worlds."""
        self.known.reset(slots, [world.task for world in worlds])

    def see(self, slots: Array, observations: GraphObservations) -> None:
        """Write what the agents see into the known graphs."""
        self.known.see(slots, observations)

    def targets(self, slots: Array) -> Array:
        """Which nodes are right: [n, N] bool."""
        known = self.known
        told = np.zeros((len(slots), known.heads.shape[1]), np.bool_)
        teach_each(slots, known.visited, known.heads, known.links, known.lengths, known.places, known.goals, told)
        return told


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
