"""What a network sees of an episode, and what its outputs mean. Each kind of world has an encoding of its own.

A class that `fogbench.learned.ENCODINGS` names for a kind, or an entry point of the group `fogbench.encodings`, is made
of the settings of a policy, so that it can show what they say. It starts a viewpoint for each episode, and turns
viewpoints into tensors: one for a decision, many for a batch of training. It may have a method `side_by_side(slots)`,
which makes viewpoints that are faster together (see `viewpoints`). Importing this imports no torch.

Words used here
    B   samples: viewpoints that are encoded together
    A   outputs of the network
"""

from collections.abc import Sequence
from typing import Any, Protocol

from fogbench.worlds.types import Array, Observation, Task


class Viewpoint(Protocol):
    """**Protocol:** what is kept of one episode so that a network can see it."""

    def see(self, observation: Observation) -> None:
        """Take in what the agent is told; once for every observation, in order."""

    def act(self, output: int) -> Any:
        """The action that an output of the network means here, once after every look; it may be remembered.

        What was seen is carried to the next decision no further than `bytes` tells.
        """

    @property
    def bytes(self) -> int:
        """What is carried from one decision to the next: the `nbytes` of arrays that grow with the world."""


class Inputs(Protocol):
    """**Protocol:** what a network sees, as tensors; for all else its network and its encoding know what is in it."""

    @property
    def image(self) -> Any:
        """[B, ...], what the network plans on; `fogbench look` shows how decisions lie in it."""

    def to(self, device: str) -> Any:
        """The same on a device."""


class Encoding(Protocol):
    """**Protocol:** from episodes of a kind of world to what a network sees, and from its outputs to actions."""

    @property
    def outputs(self) -> tuple[str, ...]:
        """What each output is called, in the order of the network's scores and of a teacher's targets: A names."""

    def start(self, task: Task) -> Any:
        """A viewpoint from which nothing was seen.

        Raises:
            Mistake: the network is not made for such a task; one line without a full stop, which says what was got and
                what was expected.
        """

    def encode(self, viewpoints: Sequence[Any]) -> Any:
        """What a network sees from some viewpoints, each after its last look: `Inputs` of B samples."""

    def open(self, inputs: Any) -> Array:
        """[B, A] bool, the outputs that are not seen to lead into an obstacle; all, where nothing is in the way."""
