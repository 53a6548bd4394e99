"""Whose code plays: what does not ship with the project is a guest, and plays on luck that is fixed for its episode."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from fogbench.bench.playing.loop import episode_stream, episode_world
from fogbench.worlds.tables import OURS
from fogbench.worlds.types import World
from fogbench.worlds.undisturbed import undisturbed

if TYPE_CHECKING:
    from fogbench.bench.reading.scenario import Scenario, Variant
    from fogbench.bench.reading.variant import Entry


def is_guest(thing: object) -> bool:
    """Whether the class of a thing does not ship with the project."""
    return not type(thing).__module__.startswith(OURS)


def guests(scenario: "Scenario") -> dict[tuple[str, str], tuple["Variant", "Entry"]]:
    """The agents that play and do not ship with the project, by variant and label."""
    return {
        (variant.name, entry.label): (variant, entry)
        for variant in scenario.variants
        for entry in variant.agents
        if not entry.skipped and is_guest(entry.settings)
    }


@contextmanager
def hosted(variant: "Variant", purpose: str, episode: int, *things: object) -> Iterator[None]:
    """Run code of some agent or map family; a guest finds the shared generators seeded, and its changes are put back.

    Its own stream stays as it is: theirs is one of another purpose.
    """
    if not any(map(is_guest, things)):
        yield
        return
    with undisturbed(int(episode_stream(variant, f"{purpose}, shared", episode).integers(2**32))):
        yield


def drawn(variant: "Variant", episode: int) -> World:
    """The world of an episode; see `fogbench.bench.playing.loop.episode_world`."""
    with hosted(variant, "map", episode, variant.family):
        return episode_world(variant, episode)
