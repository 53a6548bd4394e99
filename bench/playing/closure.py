"""What a class uses: all modules that import statements lead to, from its own on; nothing is imported to find them.

The project's own modules and a user's count by their contents, wherever they lie, and so does the whole package of the
class. What these import from other packages that are installed counts by the version of the package, the standard
library not at all. The project's `__init__` files are tables that only name things: they do not count.
"""

import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from importlib.machinery import PathFinder
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from fogbench.bench.playing.sources import Import, read_source
from fogbench.bench.reading.plugin_files import is_file

PROJECT = __name__.partition(".")[0]

INSTALLED = {"site-packages", "dist-packages"}
"""Folders of packages that are installed."""


class Closure(NamedTuple):
    """All that is used."""

    contents: frozenset[tuple[str, str]]
    """Name and digest of each module that counts by its contents; of a start that is in no package, no name."""
    packages: frozenset[str]
    """What counts by its version, or else by its name alone, as import statements name it."""


class Place(NamedTuple):
    """Where a module lies."""

    file: Path | None
    folders: tuple[str, ...]
    """Of its submodules; none where it is no package."""


def closure(*starts: type | str) -> Closure:
    """What classes use, through the modules of all that they derive from; or modules: `module` or `module:class`."""
    parts = [_closure(start) for start in starts]
    contents = frozenset[tuple[str, str]]().union(*(part.contents for part in parts))
    return Closure(contents, frozenset[str]().union(*(part.packages for part in parts)))


@cache
def _closure(start: type | str) -> Closure:
    modules = [cls.__module__ for cls in start.__mro__] if isinstance(start, type) else [start.partition(":")[0]]
    own, contents, packages = {PROJECT, _top(modules[0])}, dict[str, str](), set[str]()
    waiting, met = list(modules), set[str]()
    while waiting:
        name = waiting.pop()
        if name in met:
            continue
        met.add(name)
        if _is_elsewhere(name, own):
            packages.update({_top(name)} - sys.stdlib_module_names)
            continue
        place, holder = _find(name), name.rpartition(".")[0]
        waiting += [holder] if holder and not is_file(name) else []
        if place is None or not _is_table(name, place):
            contents[name] = _digest(place)
            waiting += _imported(name, place, own)
    if is_file(modules[0]) or "." not in modules[0]:  # a file may lie anywhere, under any name
        contents[""] = contents.pop(modules[0], "")
    return Closure(frozenset(contents.items()), frozenset(packages))


def _top(name: str) -> str:
    return name.partition(".")[0]


def _is_elsewhere(name: str, own: set[str]) -> bool:
    """Whether a module does not count by its contents: it is installed, of the standard library, or nowhere."""
    top = _top(name)
    if top in own:
        return False
    place = None if top in sys.stdlib_module_names else _find(top)
    if place and not place.file:  # folders that several may share
        place = _find(name) or place
    return place is None or not INSTALLED.isdisjoint(Path(place.file or place.folders[0]).parts)


def _is_table(name: str, place: Place) -> bool:
    return bool(place.folders) and _top(name) == PROJECT


@cache
def _find(name: str) -> Place | None:
    """Where a module lies; None if it is nowhere. Packages around it are looked up, not run."""
    loaded, holder = sys.modules.get(name), name.rpartition(".")[0]
    if loaded is not None:
        file = getattr(loaded, "__file__", None)
        return Place(Path(file) if file else None, tuple(getattr(loaded, "__path__", ())))
    around = _find(holder) if holder else None
    spec = None
    with suppress(ImportError, ValueError):
        if not holder:
            spec = find_spec(name)
        elif around and around.folders:
            spec = PathFinder.find_spec(name, around.folders)
    if spec is None:
        return None
    return Place(Path(spec.origin) if spec.origin else None, tuple(spec.submodule_search_locations or ()))


def _digest(place: Place | None) -> str:
    """Of the contents of a module; none where there are no contents."""
    with suppress(OSError):
        return read_source(place.file).digest if place and place.file else ""
    return ""


def _imported(name: str, place: Place | None, own: set[str]) -> Iterator[str]:
    """The modules that a module imports."""
    statements: tuple[Import, ...] = ()
    with suppress(OSError):
        statements = read_source(place.file).imports if place and place.file else ()
    for statement in statements:
        yield from _reached(name if place and place.folders else name.rpartition(".")[0], statement, own)


def _reached(package: str, statement: Import, own: set[str]) -> Iterator[str]:
    """The modules that a statement in a package leads to: the one that it names, and where the names come from."""
    around = package.split(".")[: len(package.split(".")) + 1 - statement.level] if statement.level else []
    module = ".".join([*around, *filter(None, [statement.module])])
    yield module
    place = None if _is_elsewhere(module, own) else _find(module)
    if place is None or not place.folders:
        return
    for name in statement.names.values() or ["*"]:
        inner = f"{module}.{name}"
        yield from [inner] if _find(inner) else _told(module, place, name, own)


def _told(package: str, place: Place, name: str, own: set[str]) -> Iterator[str]:
    """The modules that a name of a package comes from (`*`: all its names), as the stub beside its `__init__` says."""
    stub = place.file.with_suffix(".pyi") if place.file else None
    for statement in read_source(stub).imports if stub and stub.exists() else ():
        taken = {here: there for here, there in statement.names.items() if name in ("*", here)}
        if taken:
            yield from _reached(package, statement._replace(names=taken), own)
