"""Versions of installed packages, by the names that import statements have for them."""

from collections.abc import Iterable, Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, packages_distributions, version


def installed(names: Iterable[str]) -> dict[str, str]:
    """The versions of those packages that are installed here; where one is distributed by another name, with that."""
    return {name: found for name in names if (found := _version(name))}


@cache
def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        others = sorted(set(_distributions().get(name, ())))
        return ", ".join(f"{version(other)} ({other})" for other in others)


_distributions = cache(packages_distributions)  # it takes a while, and only some packages need it


def difference(names: Iterable[str], recorded: Mapping[str, str]) -> str:
    """What packages were recorded with and what is here, in one line; empty where that is the same."""
    here = installed(names)
    odd = [name for name in sorted(names) if name in recorded and here.get(name) != recorded[name]]
    if not odd:
        return ""
    return f"Recorded with {_listed(odd, recorded)}; here {'are' if len(odd) > 1 else 'is'} {_listed(odd, here)}."


def _listed(names: Iterable[str], versions: Mapping[str, str]) -> str:
    *most, last = [f"{name} {versions[name]}" if name in versions else f"no {name}" for name in names]
    return f"{', '.join(most)} and {last}" if most else last
