"""What a network sees of many graphs in one call: the viewpoints of `GraphEncoding`, as arrays."""

from collections.abc import Sequence

import numpy as np

from fogbench.learned.encoding.graph import GraphEncoding, GraphInputs
from fogbench.worlds.graph.batch import GraphObservations
from fogbench.worlds.types import Array, Task


class GraphViewpoints:
    """Goals of episodes side by side."""

    observations: GraphObservations
    """Those that no step has followed yet."""

    def __init__(self, slots: int, encoding: GraphEncoding) -> None:
        """Nobody yet."""
        self.encoding = encoding
        self.goals = np.zeros(slots, np.int64)

    def reset(self, slots: Array, tasks: Sequence[Task]) -> None:
        """Nothing is seen yet of some tasks.

        Raises:
            Mistake: a network that was made for graphs of one size meets another.
        """
        self.goals[slots] = [self.encoding.start(task).goal for task in tasks]

    def see(self, slots: Array, observations: GraphObservations) -> None:
        """Look."""
        del slots
        self.observations = observations

    def encode(self, slots: Array) -> GraphInputs:
        """What a network sees after the last look at just these slots."""
        told = self.observations
        return self.encoding.drawn(told.views[:, :, 0], told.places, self.goals[slots], told.blocked)

    def act(self, slots: Array, outputs: Array) -> Array:
        """The nodes are the outputs."""
        del slots
        return outputs
