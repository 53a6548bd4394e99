"""Plug-ins by name: from the tables of the project, other packages' entry points, a file, or a module.

Nothing is imported before a scenario names it.
"""

import ast
import sys
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

from bench.reading.blocks import near, one_of
from planners import EXTRAS, PLANNERS
from worlds import FAMILIES, KINDS
from worlds.settings import Settings
from worlds.streams import digest


class Table(NamedTuple):
    """One sort of plug-in."""

    shipped: Mapping[str, str]
    """Name to `module:class`."""
    groups: tuple[str, ...]
    """Entry points of other packages."""
    members: tuple[str, ...]
    """What a class must have."""

    def targets(self) -> dict[str, str]:
        """All names with their `module:class`; the project's own come first and cannot be replaced."""
        others = {name: target for group in self.groups for name, target in registered(group).items()}
        return {**self.shipped, **{name: target for name, target in others.items() if name not in self.shipped}}


FAMILY = Table(FAMILIES, ("fogbench.families",), ("kind", "sample", "words", "tasks"))
AGENT = Table(PLANNERS, ("fogbench.planners", "fogbench.learned"), ("kinds", "start", "parameter_bytes"))
KIND = Table(KINDS, (), ())


class PluginError(ValueError):
    """A name that leads to no class of settings; the text is what was expected."""

    def __init__(self, expected: str, near: str = "") -> None:
        """Keep the nearest valid name beside the text."""
        super().__init__(expected)
        self.near = near


class MissingPackageError(Exception):
    """A plug-in that needs a package which is not installed; the text says which, and how to get it."""


@cache
def registered(group: str) -> dict[str, str]:
    """The entry points of a group: name to `module:class`. They are looked for once, which takes a while."""
    return {point.name: point.value for point in entry_points(group=group)}


def families() -> dict[str, str]:
    """Map families: name to `module:class`."""
    return FAMILY.targets()


def agents() -> dict[str, str]:
    """Agents: name to `module:class`."""
    return AGENT.targets()


def target(table: Table, name: str, folder: Path) -> str:
    """Where the class of a name is: `module:class` or `/absolute/file.py:class`.

    Args:
        table: the sort of plug-in.
        name: a name of the table, `module:class`, or `file.py:class`.
        folder: a relative file starts there.

    Raises:
        PluginError: no such name.
    """
    place, _, class_name = name.rpartition(":")
    if place.endswith(".py"):
        return f"{Path(folder, place).resolve()}:{class_name}"
    targets = {} if place else table.targets()
    if not place and name not in targets:
        raise PluginError(f"{one_of(targets)}, or a class as file.py:Class or module:Class", near(name, targets))
    return targets.get(name, name)


def load(table: Table, name: str, target: str) -> type[Settings]:
    """The class at a target.

    Raises:
        PluginError: there is none, it cannot be imported, or it is not a class of settings for this.
        MissingPackageError: it needs a package that is not installed.
    """
    place, _, class_name = target.rpartition(":")
    module = _import(name, place)
    found = getattr(module, class_name, None)
    if not isinstance(found, type):
        classes = [key for key, thing in vars(module).items() if isinstance(thing, type)]
        raise PluginError(f"a class of {Path(place).name}, which has no {class_name}", near(class_name, classes))
    lacks = [member for member in table.members if not hasattr(found, member)]
    if not issubclass(found, Settings):
        raise PluginError(f"a class derived from worlds.settings.Settings, with {', '.join(table.members)}")
    if lacks:
        raise PluginError(f"a class with {', '.join(table.members)}; it lacks {', '.join(lacks)}")
    return found


def first_sentence(target: str) -> str:
    """The first line of the docstring of a class, without importing it; empty if it cannot be found."""
    place, _, class_name = target.rpartition(":")
    try:
        spec = find_spec(place)
        tree = ast.parse(Path(spec.origin).read_text("utf-8") if spec and spec.origin else "")
    except (ImportError, OSError, SyntaxError, ValueError):
        return ""
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == class_name]
    return (ast.get_docstring(classes[0]) or "").partition("\n")[0] if classes else ""


def _import(name: str, place: str) -> ModuleType:
    try:
        return _from_file(Path(place)) if place.endswith(".py") else import_module(place)
    except ModuleNotFoundError as error:
        missing = error.name or ""
        if f"{place}.".startswith(f"{missing}."):
            raise PluginError(f"a module that is installed; there is no {missing}") from None
        raise MissingPackageError(_how_to_get(name, missing)) from None
    except FileNotFoundError as error:
        if error.filename != place:
            raise PluginError(_raises(error)) from None
        raise PluginError(f"an existing file (looked for {place})") from None
    except Exception as error:  # noqa: BLE001  a user's file may raise anything
        raise PluginError(_raises(error)) from None


def _raises(error: Exception) -> str:
    first = str(error).strip().partition("\n")[0]
    return f"code that can be imported; it raises {type(error).__name__}: {first}"


def _how_to_get(name: str, package: str) -> str:
    if name in EXTRAS:
        return f'needs the extra {EXTRAS[name]}: pip install "fogbench[{EXTRAS[name]}]"'
    return f"needs the package {package}, which is not installed"


def _from_file(file: Path) -> ModuleType:
    """The module of a file, loaded once in a process under a name that no other file has."""
    name = f"{file.stem}_{digest(file)[:16]}"
    if name not in sys.modules:
        spec = spec_from_file_location(name, file)
        assert spec is not None
        assert spec.loader is not None
        sys.modules[name] = module_from_spec(spec)
        try:
            spec.loader.exec_module(sys.modules[name])
        except BaseException:
            del sys.modules[name]
            raise
    return sys.modules[name]
