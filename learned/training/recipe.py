"""What a training is told, as it stands in a recipe. Importing this imports no torch."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

from pydantic import Field

from fogbench.worlds.settings import Positive, Probability, Settings
from fogbench.worlds.types import MapFamily

if TYPE_CHECKING:
    from fogbench.learned.policy import Policy

Rate = Annotated[float, Field(gt=0)]
"""A number above 0."""

Weight = Annotated[float, Field(ge=0)]
"""A number from 0."""


class Teacher(Settings):
    """Who decides while training: the teacher, or the network as it is (Ross, Gordon & Bagnell 2011, "DAgger").

    The teacher takes an optimal move on the map that the agent has seen. Whoever decides, the network is taught which
    moves are optimal there.
    """

    share: tuple[Probability, Probability] = (1.0, 0.1)
    """Share of the episodes in which the teacher decides: at first, and from `until` on; `[1, 1]` is cloning."""
    until: Probability = 0.25
    """Part of the batches over which the share changes."""
    hindsight: bool = False
    """Whether, of the moves that are optimal on that map, only those count that are on the full map too, if any is."""


class Curriculum(Settings):
    """Maps that grow harder over the first batches."""

    easy: dict[str, Any]
    """Settings of the maps of every lesson at first: numbers grow to the lesson's own, the rest changes at the end."""
    until: Probability = 0.3
    """Part of the batches over which they grow."""


class Validation(Settings):
    """How often, and on how much, a network is tried while it learns."""

    episodes: Positive = 200
    """Held-out episodes of each variant."""
    every: Positive = 50
    """Batches between two trials."""


class Training(Settings):
    """How a network is trained."""

    batches: Positive
    """How many, each of fresh maps."""
    batch: Annotated[int, Field(ge=1, le=10_000)] = 128
    """Episodes of a batch."""
    teacher: Teacher = Teacher()
    curriculum: Curriculum | None = None
    optimiser: Literal["adam", "rmsprop"] = "adam"
    rate: tuple[Rate, Rate] = (1e-3, 1e-4)
    """Learning rate over the first half of the batches, and at the end of the second, over which it falls."""
    clip: Rate = 5.0
    """The gradient's norm at most."""
    access_decay: Weight = 0.0
    """Squared weights of a DNC's interface to its memory count as much in the loss (Khan et al. 2018, section 4.2)."""
    noise: Weight = 0.0
    """Standard deviation of the noise on the controller's output that it remembers."""
    validation: Validation = Validation()
    seed: Annotated[int, Field(ge=0, le=2**32 - 1)] = 0
    """Fixes the first weights, the maps to learn on and all luck; the maps it is tried on are the same for all."""


class Worlds(NamedTuple):
    """Where episodes take place."""

    family: MapFamily
    conditions: Any
    """Of the class that their kind of world names."""


class Lesson(NamedTuple):
    """Worlds to learn on."""

    worlds: Worlds
    easy: MapFamily
    """The maps at first."""


@dataclass(frozen=True, slots=True)
class Recipe:
    """One file: a network, where it learns, how, and where it is tried."""

    name: str
    about: str
    text: str
    network: "Policy"
    lessons: tuple[Lesson, ...]
    """They take turns: an episode has the lesson of its number, counted round and round."""
    held_out: Mapping[str, Worlds]
    """What the network is tried on while it learns, by the variants' names."""
    training: Training

    def places(self) -> Iterator[tuple[str, Worlds, MapFamily]]:
        """All worlds by what they are called: each lesson's, with its maps at first and at last, and each variant's."""
        for number, (worlds, easy) in enumerate(self.lessons, 1):
            yield f"lesson {number}, at first", worlds, easy
            yield f"lesson {number}", worlds, worlds.family
        for name, worlds in self.held_out.items():
            yield name, worlds, worlds.family

    def words(self) -> str:
        """All that fixes what a training leaves, as text."""
        worlds = (
            part
            for place, (_, conditions), family in self.places()
            for part in (place, family.words(), conditions.words())
        )
        return "\n".join((self.name, self.network.words(), self.training.words(), *worlds))
