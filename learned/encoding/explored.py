"""What a network sees of the graph explored so far: its nodes and edges, without their numbers.

Words used here
    B        samples
    A        outputs, the nodes of the largest graph that the network plays on
"""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from fogbench.learned.encoding.explored_inputs import Explored, ExploredInputs, encode
from fogbench.worlds.graph.known import NONE, KnownGraph
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array, Observation, Task


class Shown(Protocol):
    """What the settings of a policy say; see `fogbench.learned.macn_explored.MacnExplored`."""

    @property
    def most(self) -> int:
        """A, the nodes of the largest graph."""


class ExploredViewpoint:
    """What is kept of an episode: the graph known so far, where the agent came from; a look until the next step."""

    def __init__(self, task: Task) -> None:
        """Nothing is seen yet."""
        self.goal: int = task.goal
        self.known = KnownGraph(task.extent)
        self.place = self.before = NONE
        self.blocked = False

    def see(self, observation: Observation) -> None:
        """Look."""
        self.known.update(observation)
        if observation.place != self.place:
            self.before, self.place = self.place, observation.place
        self.blocked = observation.blocked

    def act(self, output: int) -> int:
        """Go to a node."""
        return output

    @property
    def bytes(self) -> int:
        """The known graph."""
        return self.known.bytes


class ExploredEncoding:
    """The graph explored so far; the outputs are the nodes of the largest graph, of which those beside it count."""

    def __init__(self, settings: Shown) -> None:
        """Show what the settings say."""
        self.most = settings.most
        self.outputs = tuple(f"node {node}" for node in range(self.most))

    def start(self, task: Task) -> ExploredViewpoint:
        """A viewpoint from which nothing was seen.

        Raises:
            Mistake: the graph is larger than the largest.
        """
        if task.extent[0] > self.most:
            raise Mistake(f"got a graph of {int(task.extent[0])} nodes; expected at most {self.most} (set by `most`)")
        return ExploredViewpoint(task)

    def encode(self, viewpoints: Sequence[ExploredViewpoint]) -> ExploredInputs:
        """What a network sees from some viewpoints."""
        return encode(gather(viewpoints))

    def open(self, inputs: ExploredInputs) -> Array:
        """[B, A] bool, the neighbours."""
        is_open = np.zeros((len(inputs.told), self.most), np.bool_)
        owners = inputs.owners.cpu().numpy()
        is_open[owners, inputs.neighbours.cpu().numpy() - inputs.nodes.cpu().numpy()[owners]] = True
        return is_open


def gather(viewpoints: Sequence[ExploredViewpoint]) -> Explored:
    """What is known from some viewpoints."""
    graphs = [viewpoint.known for viewpoint in viewpoints]
    units = [graph.lengths[: graph.used].mean() if graph.used else 1.0 for graph in graphs]
    straight = [straight_to(each.known, each.goal) / unit for each, unit in zip(viewpoints, units, strict=True)]
    places, before, goals = (
        np.array([getattr(viewpoint, name) for viewpoint in viewpoints], np.int64)
        for name in ("place", "before", "goal")
    )
    return Explored(
        np.cumsum([0, *(len(graph.heads) for graph in graphs)]),
        np.cumsum([0, *(graph.used for graph in graphs)]),
        np.concatenate([graph.heads for graph in graphs]),
        np.concatenate([graph.links[: graph.used] for graph in graphs]),
        np.concatenate([graph.lengths[: graph.used] / unit for graph, unit in zip(graphs, units, strict=True)]),
        np.concatenate([graph.visited for graph in graphs]),
        np.concatenate(straight),
        places,
        before,
        goals,
        np.array([viewpoint.blocked for viewpoint in viewpoints]),
    )


def straight_to(known: KnownGraph, goal: int) -> Array:
    """The straight line from each node to the goal [N]; infinite where it is not known where the node is."""
    if not known.coordinates.size:
        return np.full(len(known.heads), np.inf)
    seen = np.isfinite(known.coordinates[:, 0])
    lines = np.full(len(seen), np.inf)
    lines[seen] = np.sqrt(np.square(known.coordinates[seen] - known.coordinates[goal]).sum(1))
    return lines
