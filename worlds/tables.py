"""Names of things, here and in other packages, as `module:object`; nothing is imported before it is asked for."""

import sys
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from pkgutil import resolve_name
from types import ModuleType
from typing import Any

from fogbench.worlds.mistake import Mistake
from fogbench.worlds.undisturbed import undisturbed

OURS = ("fogbench.worlds.", "fogbench.planners.", "fogbench.learned.")
"""What the names of modules begin with that ship with the project."""


@cache
def registered(group: str) -> dict[str, str]:
    """The entry points of a group: name to `module:object`. They are looked for once, which takes a while."""
    return {point.name: point.value for point in entry_points(group=group)}


def named(table: Mapping[str, Any], group: str, name: str) -> Any | None:
    """What a table, or else an entry point of another package, names; None where neither does.

    Args:
        table: names to things, or to `module:object`; it comes first and cannot be replaced.
        group: of entry points.
        name: what is looked for.

    Raises:
        Mistake: what is named cannot be imported.
    """
    found = table.get(name) or registered(group).get(name)
    return imported(found, f"{group}: {name}") if isinstance(found, str) else found


@cache
def imported(target: str, place: str) -> Any:
    """What stands at `module:object`.

    Raises:
        Mistake: nothing does, or it cannot be imported; the text says who wants it.
    """
    try:
        brought(target.partition(":")[0])
        return resolve_name(target)
    except Exception as error:  # noqa: BLE001  a user's module may raise anything
        told = f"got {target}, which raises {type(error).__name__}: {error}"
        raise Mistake(f"{place}: {told}; expected something that can be imported.") from None


def brought(module: str) -> ModuleType:
    """Import a module; one that does not ship with the project leaves this process as it was.

    Raises:
        Exception: whatever it raises.
    """
    if module in sys.modules or module.startswith(OURS):
        return import_module(module)
    with undisturbed(seed=0):
        return import_module(module)
