"""Keys of episodes: equal keys, equal episodes. A changed setting, seed, map file or source changes them."""

import sys
from functools import cache
from hashlib import sha256
from pathlib import Path

from fogbench import planners, worlds
from fogbench.bench.reading.scenario import Variant
from fogbench.bench.reading.variant import Entry
from fogbench.worlds.settings import Settings
from fogbench.worlds.streams import digest

DECIDE = ("loop.py",)
"""Files of the harness that decide what an episode is."""


def world_key(variant: Variant) -> str:
    """The key of all that an episode of a variant depends on, without its agent: 64 hexadecimal digits."""
    return digest(
        variant.seed,
        variant.family.words(),
        variant.conditions.model_dump_json(),
        _sources(type(variant.family).__module__),
        _folder(Path(worlds.__file__).parent),
        *(_file(Path(__file__).with_name(name)) for name in DECIDE),
    )


def agent_key(entry: Entry) -> str:
    """The key of an agent: its class, its settings, its sources and those of the planners; not its label.

    Raises:
        TypeError: an agent without settings, which was skipped.
    """
    if not isinstance(entry.settings, Settings):
        raise TypeError(f"{entry.label} has no settings: {entry.skipped}")
    classes = [cls for cls in type(entry.settings).__mro__ if issubclass(cls, Settings) and cls is not Settings]
    return digest(
        entry.settings.words(),
        *dict.fromkeys(_sources(cls.__module__) for cls in classes),
        _folder(Path(planners.__file__).parent),
    )


def _sources(module: str) -> str:
    """The digest of the whole package that a module is in, or of the file of a module that is in none."""
    top = sys.modules[module.partition(".")[0]]
    if hasattr(top, "__path__"):
        return digest(*(_folder(Path(folder)) for folder in top.__path__))
    return _file(Path(str(top.__file__)))


@cache
def _folder(folder: Path) -> str:
    files = sorted(folder.rglob("*.py"))
    return digest(*(part for file in files for part in (file.relative_to(folder).as_posix(), _file(file))))


@cache
def _file(file: Path) -> str:
    return sha256(file.read_bytes()).hexdigest()
