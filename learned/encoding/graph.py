"""What a network sees of a graph, as in Khan et al. 2018: the row of its node, and the goal, each made a square.

Words used here
    B, N, S    samples, nodes, the side of the square: S * S = N
"""

from collections.abc import Sequence
from pkgutil import resolve_name
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np
import torch
from torch import Tensor

from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array, Observation, Task

if TYPE_CHECKING:
    from fogbench.learned.encoding.viewpoints import Viewpoints


class Shown(Protocol):
    """What the settings of a policy say of what it is shown; see `fogbench.learned.graph_policy.GraphPolicy`."""

    @property
    def nodes(self) -> int:
        """N, a square number."""

    @property
    def plane(self) -> tuple[int, int]:
        """S and S."""


class GraphInputs(NamedTuple):
    """What a network sees, for a batch."""

    image: Tensor
    """[B, 3, S, S] float32: the neighbours of the agent's node, the goal, the node."""
    cells: Tensor
    """[B] int64, the agents' nodes."""
    blocked: Tensor
    """[B, 1] float32, whether the last action was no neighbour."""

    @property
    def beside(self) -> tuple[Tensor, Tensor]:
        """What a memory is told as it is: [B, 3 * N] and [B, 1]."""
        return self.image.flatten(1), self.blocked

    def to(self, device: str) -> "GraphInputs":
        """The same on a device."""
        return self if self.image.device.type == device else GraphInputs(*(part.to(device) for part in self))


class GraphViewpoint:
    """What is kept of an episode: the goal; a look until the next step."""

    observation: Observation
    """Of the look that no step has followed yet."""
    bytes = 0

    def __init__(self, goal: int) -> None:
        """Nothing is seen yet."""
        self.goal = goal

    def see(self, observation: Observation) -> None:
        """Look."""
        self.observation = observation

    def act(self, output: int) -> int:
        """Go to a node; nothing of the look is carried on."""
        del self.observation
        return output


class GraphEncoding:
    """Three squares, of which the memory is told each number too; the outputs are the nodes."""

    def __init__(self, settings: Shown) -> None:
        """Show what the settings say."""
        self.nodes, self.plane = settings.nodes, settings.plane
        self.outputs = tuple(f"node {node}" for node in range(self.nodes))

    def start(self, task: Task) -> GraphViewpoint:
        """A viewpoint from which nothing was seen.

        Raises:
            Mistake: a network that was made for graphs of one size meets another.
        """
        if task.extent != (self.nodes,):
            raise Mistake(f"got a graph of {int(task.extent[0])} nodes; expected {self.nodes}, the size")
        return GraphViewpoint(task.goal)

    def side_by_side(self, slots: int) -> "Viewpoints":
        """Viewpoints of so many episodes; they are named by a string, for no single episode depends on them."""
        made: Viewpoints = resolve_name("fogbench.learned.encoding.graph_batch:GraphViewpoints")(slots, self)
        return made

    def encode(self, viewpoints: Sequence[GraphViewpoint]) -> GraphInputs:
        """What a network sees from some viewpoints."""
        observations = [viewpoint.observation for viewpoint in viewpoints]
        lengths = np.stack([observation.view[:, 0] for observation in observations])  # [B, N]
        places, goals = [observation.place for observation in observations], [each.goal for each in viewpoints]
        blocked = np.array([observation.blocked for observation in observations])
        return self.drawn(lengths, np.array(places), np.array(goals), blocked)

    def drawn(self, lengths: Array, places: Array, goals: Array, blocked: Array) -> GraphInputs:
        """What is seen from nodes [B], whose rows have these lengths [B, N], infinite where no edge leads."""
        image, batch = np.zeros((len(places), 3, self.nodes), np.float32), np.arange(len(places))
        image[:, 0] = np.isfinite(lengths)
        image[batch, 1, goals] = image[batch, 2, places] = 1
        squares = torch.from_numpy(image.reshape(-1, 3, *self.plane))
        return GraphInputs(squares, torch.from_numpy(places), torch.from_numpy(blocked[:, None].astype(np.float32)))

    def open(self, inputs: GraphInputs) -> Array:
        """[B, N] bool, the neighbours."""
        is_open: Array = (inputs.image[:, 0].flatten(1) > 0).cpu().numpy()
        return is_open
