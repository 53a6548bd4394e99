"""Plug-ins by name: from the tables of the project, other packages' entry points, a file, or a module.

Nothing is imported before a scenario names it.
"""

from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import TypeVar

from fogbench.bench.reading.plugin_files import module_name
from fogbench.bench.reading.tables import EXTRAS, KIND, PACKAGES, Table
from fogbench.worlds import KINDS, Kind
from fogbench.worlds.mistake import Unavailable, near, one_of, shown
from fogbench.worlds.reading.blocks import raised
from fogbench.worlds.settings import Settings
from fogbench.worlds.tables import brought, registered

Thing = TypeVar("Thing")


class PluginError(ValueError):
    """A name that leads to no class of settings; the text is what was expected."""

    def __init__(self, expected: str, near: str = "") -> None:
        """Keep the nearest valid name beside the text."""
        super().__init__(expected)
        self.near = near


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
        Unavailable: it needs a package that is not installed; the text says which, and how to get it.
    """
    if absent := [package for package in PACKAGES.get(EXTRAS.get(name, ""), ()) if not _is_installed(package)]:
        raise Unavailable(_how_to_get(name, absent[0]))
    found = _thing(name, target, type, "class")
    lacks = [member for member in table.members if not hasattr(found, member)]
    if not issubclass(found, Settings):
        raise PluginError(f"a class derived from fogbench.Settings, with {', '.join(table.members)}")
    if lacks:
        raise PluginError(f"a class with {', '.join(table.members)}; it lacks {', '.join(lacks)}")
    return found


def load_conditions(name: str, kind: Kind) -> type[Settings]:
    """The class of the conditions of a kind of world.

    Raises:
        PluginError: there is none, or it says no budget.
        Unavailable: it needs a package that is not installed.
    """
    found = load(KIND, name, kind.conditions)
    if "budget" not in found.model_fields:
        raise PluginError(f"a kind of world whose conditions have a budget; those of {shown(name)} have none")
    return found


def load_kind(name: str) -> Kind:
    """A kind of world by its name.

    Raises:
        PluginError: there is none.
        Unavailable: its package lacks another, which is not installed.
    """
    others = registered("fogbench.kinds")
    if name not in {**KINDS, **others}:
        raise PluginError(one_of([*KINDS, *others]), near(name, [*KINDS, *others]))
    return KINDS[name] if name in KINDS else _thing(name, others[name], Kind, "kind of world")


def _thing(name: str, target: str, sort: type[Thing], told: str) -> Thing:
    """What stands at a target, of some sort."""
    place, _, own = target.rpartition(":")
    module = _import(name, place)
    found = getattr(module, own, None)
    if isinstance(found, sort):
        return found
    others = [key for key, thing in vars(module).items() if isinstance(thing, sort)]
    raise PluginError(f"a {told} of {Path(place).name}, which has no {shown(own)}", near(own, others))


def _import(name: str, place: str) -> ModuleType:
    try:
        return brought(module_name(Path(place)) if place.endswith(".py") else place)
    except ModuleNotFoundError as error:
        missing = error.name or ""
        if f"{place}.".startswith(f"{missing}."):
            raise PluginError(f"a module that is installed; there is no {shown(missing)}") from None
        if _lies_beside(Path(place), missing):
            alone = f"one file alone, or a package that is installed; it imports {shown(missing)}, which lies beside it"
            raise PluginError(alone) from None
        raise Unavailable(_how_to_get(name, missing)) from None
    except FileNotFoundError as error:
        if error.filename != place:
            raise PluginError(_importable(error)) from None
        raise PluginError(f"an existing file (looked for {place})") from None
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001  a user's file may raise anything
        raise PluginError(_importable(error)) from None


def _is_installed(package: str) -> bool:
    """Whether a package can be found; it is not imported."""
    try:
        return find_spec(package) is not None
    except ValueError:  # somebody has put something else in its place
        return False


def _importable(error: BaseException) -> str:
    return f"code that can be imported; it raises {raised(error)}"


def _lies_beside(file: Path, module: str) -> bool:
    """Whether a module that was not found is in the folder of the file that asked for it."""
    place = file.parent / module.partition(".")[0]
    return file.suffix == ".py" and place != file.parent and (place.is_dir() or place.with_suffix(".py").is_file())


def _how_to_get(name: str, package: str) -> str:
    if name in EXTRAS:
        return f'needs the extra {EXTRAS[name]}: pip install ".[{EXTRAS[name]}]"'
    return f"needs the package {shown(package)}, which is not installed"
