"""Names of things, here and in other packages, as `module:object`; nothing is imported before it is asked for."""

from collections.abc import Mapping
from functools import cache
from importlib.metadata import entry_points
from pkgutil import resolve_name
from typing import Any


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
    """
    found = table.get(name) or registered(group).get(name)
    return resolve_name(found) if isinstance(found, str) else found
