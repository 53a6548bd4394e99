"""A family of rings."""

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from fogbench import BLOCKED, FREE, MapError, Probability, Settings
from ring_kind.conditions import RingConditions
from ring_kind.world import RingWorld


class Stations(Settings):
    """A ring of which one link is cut, with some probability."""

    kinds: ClassVar[tuple[str, ...]] = ("ring",)

    size: Annotated[int, Field(ge=3)]
    """How many stations."""
    cut: Probability = 0.0
    """Probability that a link is cut."""

    def sample(self, rng: np.random.Generator, episode: int, conditions: RingConditions) -> RingWorld:
        """A ring with a task that fits."""
        del episode
        for _ in range(100):
            links = np.full(self.size, FREE, np.uint8)  # [N]
            if rng.random() < self.cut:
                links[rng.integers(self.size)] = BLOCKED
            start, goal = rng.choice(self.size, size=2, replace=False).tolist()
            found = conditions.ring(links, start, goal)
            if found is not None:
                return found
        raise MapError(f"Stations: no task with {conditions.wanted()} was found on 100 rings")

    def tasks(self, conditions: RingConditions, most: int) -> int | None:
        """Any number."""
        del conditions, most
        return None

    def extent(self) -> tuple[float, ...] | None:
        """Its stations."""
        return (self.size,)
