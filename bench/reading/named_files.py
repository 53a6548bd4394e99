"""The files that settings name, whatever the types of their fields are: weights, maps, lists of tasks."""

import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel


def named_files(settings: Any, folder: Path) -> tuple[Path, ...]:
    """All files that a text or a path in settings leads to, once each.

    A relative one may start at the folder of the page, beside the module of the settings, or where the user stands:
    nobody knows how the class will look for it, so each that is there counts.

    Args:
        settings: of a map family or an agent.
        folder: of the page that they are from.
    """
    module = getattr(sys.modules.get(type(settings).__module__), "__file__", None)
    around = [folder, *([Path(module).parent] if module else []), Path()]
    found = (Path(place, text).absolute() for text in _texts(settings) for place in around)
    return tuple(file for file in dict.fromkeys(found) if _is_file(file))


def _texts(value: Any) -> Iterator[str | Path]:
    """All texts and paths in a value."""
    if isinstance(value, str | Path):
        yield value
    elif isinstance(value, BaseModel):
        yield from _texts(vars(value))
    elif isinstance(value, Iterable) and not isinstance(value, bytes):
        for each in value.values() if isinstance(value, Mapping) else value:
            yield from _texts(each)


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # a text that is too long for a path, or has a zero byte
        return False
