"""Keys of episodes: equal keys, equal episodes. A changed setting, seed, map file or source changes them."""

import sys
from functools import cache
from pathlib import Path

from pydantic import BaseModel

import planners
import worlds
from bench.reading.scenario import Entry, Variant
from worlds.streams import digest

DECIDE = ("judge.py", "loop.py")
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
    if not isinstance(entry.settings, BaseModel):
        raise TypeError(f"{entry.label} has no settings: {entry.skipped}")
    settings = type(entry.settings)
    return digest(
        settings.__name__,
        entry.settings.model_dump_json(),
        _sources(settings.__module__),
        _folder(Path(planners.__file__).parent),
    )


def _sources(module: str) -> str:
    """The digest of the package of a module, or of the file of a module that is in no package."""
    path = Path(str(sys.modules[module].__file__))
    return _folder(path.parent) if "." in module else _file(path)


@cache
def _folder(folder: Path) -> str:
    return digest(*(part for file in sorted(folder.glob("*.py")) for part in (file.name, _file(file))))


@cache
def _file(file: Path) -> str:
    return digest(file.read_text("utf-8"))
