"""The names of plug-ins, and where their classes are: told without importing any of them, or anything heavy."""

import ast
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from fogbench import learned, planners
from fogbench.worlds import FAMILIES, KINDS
from fogbench.worlds.tables import registered


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


FAMILY = Table(FAMILIES, ("fogbench.families",), ("kinds", "sample", "words", "tasks", "extent"))
AGENT = Table(
    {**planners.PLANNERS, **learned.LEARNED},
    ("fogbench.planners", "fogbench.learned"),
    ("kinds", "start", "parameter_bytes"),
)
NETWORK = Table(learned.LEARNED, ("fogbench.learned",), (*AGENT.members, "network", "encoding"))
LEARNER = Table(learned.LEARNERS, ("fogbench.learners",), ("student", "words"))
KIND = Table({name: kind.conditions for name, kind in KINDS.items()}, ("fogbench.kinds",), ("covariates",))

EXTRAS = {**planners.EXTRAS, **learned.EXTRAS, **{name: kind.extra for name, kind in KINDS.items() if kind.extra}}
"""The extra of the project that an agent or a kind of world needs."""

PACKAGES = learned.PACKAGES
"""Packages of an extra that an agent needs even though its settings can be imported without them."""


def families() -> dict[str, str]:
    """Map families: name to `module:class`."""
    return FAMILY.targets()


def agents() -> dict[str, str]:
    """Agents: name to `module:class`."""
    return AGENT.targets()


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
