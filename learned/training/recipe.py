"""What a training is told, as it stands in a recipe. Importing this imports no torch."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from fogbench.worlds.settings import Positive, Settings
from fogbench.worlds.types import MapFamily

if TYPE_CHECKING:
    from fogbench.learned.policy import Policy


class Validation(Settings):
    """How often, and on how much, a network is tried while it learns."""

    episodes: Positive = 200
    """Held-out episodes of each variant."""
    every: Positive = 50
    """Batches between two trials."""


class Student(Protocol):
    """**Protocol:** a network that learns batch by batch."""

    batches: int
    """Learned from so far."""

    @property
    def network(self) -> Any:
        """The network, with its weights as they are now."""

    def learn(self) -> float:
        """Learn from one more batch; the loss before.

        Raises:
            Mistake: the weights would be numbers no longer; they stay as they were.
        """

    def state(self) -> dict[str, Any]:
        """All of it that changes, as PyTorch saves it."""

    def restore(self, state: Mapping[str, Any]) -> None:
        """Become as it was; the state may have more in it."""


class Learner(Protocol):
    """**Protocol:** the frozen settings of a way to learn; its fields are its block under `learning:` in a recipe.

    One with a `curriculum` whose `easy` are settings of maps finds them read for each lesson (`Lesson.easy`).
    """

    @property
    def batches(self) -> int:
        """How many there are."""

    def student(self, recipe: "Recipe") -> Student:
        """A network before its first batch.

        Raises:
            Mistake: it cannot learn so; the text is one line.
        """

    def words(self) -> str:
        """All that fixes how it learns, as text."""


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
    learning: Learner
    validation: Validation
    seed: int
    """Fixes the first weights, the maps to learn on and all luck; the maps it is tried on are the same for all."""

    def places(self) -> Iterator[tuple[str, Worlds, MapFamily]]:
        """All worlds by what they are called: each lesson's, with its maps at first and at last, and each variant's."""
        for number, (worlds, easy) in enumerate(self.lessons, 1):
            yield f"lesson {number}, at first", worlds, easy
            yield f"lesson {number}", worlds, worlds.family
        for name, worlds in self.held_out.items():
            yield name, worlds, worlds.family

    def words(self) -> str:
        """All that fixes what a training leaves, as text."""
        how = self.network.words(), self.learning.words(), self.validation.words(), str(self.seed)
        worlds = (
            part
            for place, (_, conditions), family in self.places()
            for part in (place, family.words(), conditions.words())
        )
        return "\n".join((self.name, *how, *worlds))
