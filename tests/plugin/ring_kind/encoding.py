"""What a network sees of a ring."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from fogbench import BLOCKED, Array, Observation, Task
from ring_kind.world import KnownRing, Way, ahead

NUMBERS = 5
"""Of an image: the links clockwise and back, how far both ways are, and whether the last step was blocked."""


class RingInputs(NamedTuple):
    """What a network sees, for a batch."""

    image: Any
    """[B, NUMBERS] float32."""

    def to(self, device: str) -> "RingInputs":
        """The same on a device."""
        return RingInputs(self.image.to(device))


class RingViewpoint:
    """What is kept of an episode: the ring known so far."""

    place: int
    blocked: bool

    def __init__(self, task: Task) -> None:
        """Nothing is seen yet."""
        self.goal: int = task.goal
        self.known = KnownRing(int(task.extent[0]))

    def see(self, observation: Observation) -> None:
        """Look."""
        self.place, self.blocked = observation.place, observation.blocked
        self.known.update(observation)

    def act(self, output: int) -> Way:
        """The way of an output."""
        return Way(output)

    @property
    def bytes(self) -> int:
        """The known ring."""
        return self.known.links.nbytes


class RingEncoding:
    """Two links, two distances; the outputs are the two ways."""

    outputs = ("clockwise", "back")

    def __init__(self, settings: Any) -> None:
        """Nothing of the settings is needed."""

    def start(self, task: Task) -> RingViewpoint:
        """A viewpoint from which nothing was seen."""
        return RingViewpoint(task)

    def encode(self, viewpoints: Sequence[RingViewpoint]) -> RingInputs:
        """What a network sees from some viewpoints."""
        import torch  # noqa: PLC0415  whoever only reads settings need not have it

        rows = [_numbers(viewpoint) for viewpoint in viewpoints]
        return RingInputs(torch.tensor(np.array(rows, np.float32)))

    def open(self, inputs: RingInputs) -> Array:
        """[B, 2] bool, the links that are not cut."""
        is_open: Array = (inputs.image[:, :2] == 0).numpy()
        return is_open


def _numbers(viewpoint: RingViewpoint) -> list[float]:
    links, place = viewpoint.known.links, viewpoint.place
    cut = [float(links[link] == BLOCKED) for link in (place, place - 1)]
    ways = ahead(links, place, viewpoint.goal)
    return [*cut, *(min(way, 2 * len(links)) / len(links) for way in ways), float(viewpoint.blocked)]
