"""What a training is told, as it stands in a recipe. Importing this imports no torch."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, Protocol

from pydantic import Field

from fogbench.worlds.settings import Positive, Settings
from fogbench.worlds.types import MapFamily

if TYPE_CHECKING:
    from fogbench.learned.policy import Policy

TOLD = 3
"""Differences of two recipes that are told one by one."""


class Validation(Settings):
    """How often, and on how much, a network is tried while it learns."""

    episodes: Annotated[int, Field(ge=1, le=10_000)] = 200
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

    def settings(self) -> dict[str, Any]:
        """All that it says, by the keys of its file and the places of `places`: what a difference is told by."""
        said: dict[str, Any] = {"name": self.name, "seed": self.seed, "network": self.network}
        said |= {"learning": self.learning, "validation": self.validation}
        worlds = {place: {"maps": family, **dict(conditions)} for place, (_, conditions), family in self.places()}
        return flat(said | worlds)

    def words(self) -> str:
        """All that fixes what a training leaves, as text."""
        how = self.network.words(), self.learning.words(), self.validation.words(), str(self.seed)
        worlds = (
            part
            for place, (_, conditions), family in self.places()
            for part in (place, family.words(), conditions.words())
        )
        return "\n".join((self.name, *how, *worlds))


def flat(said: Any, above: str = "") -> dict[str, Any]:
    """Settings in settings, each by the keys that lead to it: `{"network.hidden": 256}`."""
    if isinstance(said, Settings):
        said = said.model_dump(mode="json")
    if not isinstance(said, Mapping):
        return {above: said}
    below = [flat(inner, f"{above}.{name}".lstrip(".")) for name, inner in said.items()]
    return {key: value for inner in below for key, value in inner.items()}


def differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> str:
    """What differs between two `settings`: `learning.batches 30, now 40`; empty where nothing does."""
    odd = [key for key in {**before, **now} if before.get(key, "missing") != now.get(key, "missing")]
    told = [f"{key} {before.get(key, 'missing')}, now {now.get(key, 'missing')}" for key in odd[:TOLD]]
    return "; ".join([*told, f"and {len(odd) - TOLD} more"] if len(odd) > TOLD else told)
