"""Keys of episodes: equal keys, equal episodes. A changed setting, seed, file, source or package changes them.

Of the sources only those count that the classes which play lead to by their imports: see
`fogbench.bench.playing.closure`. Of a file that a setting names the contents count.
"""

from collections.abc import Iterable, Mapping
from functools import cache
from itertools import chain
from pathlib import Path
from typing import Any

from fogbench.bench.playing.closure import closure
from fogbench.bench.playing.packages import installed
from fogbench.bench.playing.sources import read_source
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.reading.variant import Entry
from fogbench.planners import judge_of, reference_of
from fogbench.worlds.settings import Settings
from fogbench.worlds.streams import digest

DECIDE = ("fogbench.bench.playing.loop", "fogbench.bench.playing.facts")
"""What says what an episode is, and what its row says of its world."""

Versions = Mapping[str, str]
"""Of packages, by the name that import statements have for them."""


def world_key(variant: Variant, versions: Versions | None = None) -> str:
    """The key of all that an episode of a variant depends on, without its agent: 64 hexadecimal digits.

    Args:
        variant: of a scenario.
        versions: of the packages; None: those that are installed here.
    """
    words = variant.seed, variant.kind, variant.family.words(), variant.conditions.words()
    return digest(*words, *_contents(variant.files), _used(_of_world(variant), versions))


def agent_key(entry: Entry, versions: Versions | None = None) -> str:
    """The key of an agent: its settings and all that they use; not its label.

    Args:
        entry: of a variant.
        versions: as for `world_key`.

    Raises:
        TypeError: an agent without settings, which was skipped.
    """
    return digest(_settings(entry).words(), *_contents(entry.files), _used(_of_agent(entry), versions))


def keys(scenario: Scenario, versions: Versions | None = None) -> dict[tuple[str, str], tuple[str, str]]:
    """The `agent_key` and `world_key` of each variant and agent that plays, by both names, in their order."""
    found = dict[tuple[str, str], tuple[str, str]]()
    for variant in scenario.variants:
        own = world_key(variant, versions)
        playing = (entry for entry in variant.agents if not entry.skipped)
        found |= {(variant.name, entry.label): (agent_key(entry, versions), own) for entry in playing}
    return found


def packages(scenario: Scenario) -> list[str]:
    """The packages whose versions are in the keys of a scenario, in the order of their names."""
    agents = (_of_agent(entry) for variant in scenario.variants for entry in variant.agents if not entry.skipped)
    return sorted(closure(*chain(*map(_of_world, scenario.variants), *agents)).packages)


def _of_world(variant: Variant) -> tuple[type | str, ...]:
    """What makes an episode, without its agent."""
    return type(variant.family), type(variant.conditions), *_measures(variant), *DECIDE


def _measures(variant: Variant) -> tuple[type | str, ...]:
    """The judge and the reference of a kind of world."""
    judge, reference = judge_of(variant.kind), reference_of(variant.kind)
    return *((judge,) if hasattr(judge, "judge") else ()), *((reference.settings,) if reference else ())


def _of_agent(entry: Entry) -> tuple[type | str, ...]:
    """The class of an agent's settings, and whatever it says that it uses besides, as `module` or `module:class`."""
    settings: Any = _settings(entry)
    uses = getattr(settings, "uses", None)  # which may be a setting of a user's
    return type(settings), *(uses() if callable(uses) else ())


def _settings(entry: Entry) -> Settings:
    if not isinstance(entry.settings, Settings):
        raise TypeError(f"{entry.label} has no settings: {entry.skipped}")
    return entry.settings


def _contents(files: Iterable[Path]) -> list[str]:
    return [read_source(file).digest for file in files]


def _used(starts: tuple[type | str, ...], versions: Versions | None) -> str:
    """The digest of all that is used."""
    return _digest(starts, versions) if versions is not None else _used_here(starts)


@cache
def _used_here(starts: tuple[type | str, ...]) -> str:
    return _digest(starts, installed(closure(*starts).packages))


def _digest(starts: tuple[type | str, ...], versions: Versions) -> str:
    contents, names = closure(*starts)
    classes = [start.__qualname__ if isinstance(start, type) else start for start in starts]
    return digest(*classes, *chain(*sorted(contents)), *(f"{name} {versions.get(name, '')}" for name in sorted(names)))
