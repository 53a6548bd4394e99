"""The settings that a name takes: keys, values, defaults and what each means, from the settings class itself."""

import json
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from rich.console import Console
from rich.table import Table
from rich.text import Text

from fogbench.bench.reading.page import Page
from fogbench.bench.reading.plugins import PluginError, load, load_conditions, load_kind, target
from fogbench.bench.reading.recipe import RecipePage
from fogbench.bench.reading.tables import AGENT, FAMILY, KIND, LEARNER
from fogbench.bench.reading.tables import Table as Names
from fogbench.bench.shipped import checkpoints, find, recipes
from fogbench.worlds.mistake import Mistake, Unavailable, unknown
from fogbench.worlds.reading.shapes import Schema, Shape, shape
from fogbench.worlds.settings import Settings

PLACED = Names({}, (), ())
"""Classes that are named by their place."""

PAGES: dict[str, type[Settings]] = {"scenario": Page, "recipe": RecipePage}
"""The keys of whole files."""


class Row(NamedTuple):
    """One setting."""

    key: str
    value: str
    about: str


def show_settings(name: str) -> None:
    """Print the settings of a map family, an agent, a learner, a block of conditions, a kind of file, or a class.

    Args:
        name: as in a scenario or a recipe: of a table, `file.py:Class`, or `module:Class`.

    Raises:
        Mistake: nothing has that name; the nearest is told.
    """
    console = Console()
    for settings in _named(name):
        title = f"{name} ({settings.__module__}:{settings.__qualname__})"
        table = Table("key", "value", "about", title=Text(title), caption=Text(_first(settings.__doc__)))
        for row in (*rows(shape(settings)), *(_of_blocks() if settings in PAGES.values() else ())):
            table.add_row(*map(Text, row))
        told = f"{name} has no settings. {_first(settings.__doc__)}".strip()
        console.print(table if table.row_count else Text(told))


def rows(shape: Shape, above: str = "") -> Iterator[Row]:
    """All settings at a place, each with those below it."""
    for option in shape.options:
        for key, schema in option.get("properties", {}).items():
            inner = shape.at(key)
            needed = "required" if key in option.get("required", ()) else _default(schema.get("default", {}))
            yield Row(f"{above}{key}", f"{inner.words()}\n{needed}".strip(), _about(schema, inner))
            yield from rows(inner, f"{above}{key}.")


def _of_blocks() -> Iterator[Row]:
    """The blocks that a whole file has beside its own keys."""
    for name, block in dict(_blocks()).items():
        yield Row(name, f"a mapping\nsee `fogbench list {name}`", _first(block.__doc__))


def _default(value: Any) -> str:
    """What stands for a setting that is left out; a mapping says so key by key."""
    return "" if isinstance(value, dict) else f"default: {value if isinstance(value, str) else json.dumps(value)}"


def _about(schema: Schema, inner: Shape) -> str:
    """What a setting means; of a block without a word of its own, what the block is."""
    own = [schema.get("description"), *(each.get("description") for each in inner.options)]
    return _first(next(filter(None, own), ""))


def _first(text: str | None) -> str:
    """The first paragraph."""
    return " ".join((text or "").strip().partition("\n\n")[0].split())


def _named(name: str) -> list[type[Settings]]:
    """The classes of a name.

    Raises:
        Mistake: there is none, or it cannot be imported.
    """
    try:
        if ":" in name:
            return [load(PLACED, name, target(PLACED, name, Path()))]
        tables = [table for table in (FAMILY, AGENT, LEARNER) if name in table.targets()]
        found = [load(table, name, table.targets()[name]) for table in tables]
        found += [page for own, page in PAGES.items() if own == name]
        blocks = _blocks()
        found += [block for own, block in blocks if own == name]
    except PluginError as error:
        raise Mistake(f"{name}: expected {error}.") from None
    except Unavailable as error:
        raise Mistake(f"{name}: {error}.") from None
    if not found:
        names = [
            *FAMILY.targets(),
            *AGENT.targets(),
            *LEARNER.targets(),
            *PAGES,
            *dict.fromkeys(own for own, _ in blocks),
        ]
        raise _file_of(name) or unknown("list", name, names, also=_files())
    return found


def _file_of(name: str) -> Mistake | None:
    """That a name is that of a shipped file, if it is: what it says stands there."""
    paths = _files().get(name, ())
    return Mistake(f"{name}: the name of a file, which has no settings; read {' or '.join(paths)}.") if paths else None


def _files() -> dict[str, list[str]]:
    """The shipped files by their names, which some share."""
    found = defaultdict[str, list[str]](list)
    for files in ({path.stem: path for path in find(None)}, recipes(), checkpoints()):
        for name, path in files.items():
            found[name].append(str(path))
    return found


def _blocks() -> list[tuple[str, type[Settings]]]:
    """The blocks of all kinds of world that are at hand."""
    found: list[tuple[str, Any]] = []
    for kind in KIND.targets():
        try:
            conditions = load_conditions(kind, load_kind(kind))
        except (PluginError, Unavailable):
            continue
        found += [(name, field.annotation) for name, field in conditions.model_fields.items()]
    return [(name, block) for name, block in found if isinstance(block, type) and issubclass(block, Settings)]
