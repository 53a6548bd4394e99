"""Classes that a page names: of map families, kinds of world, agents and networks, with every mistake at its name."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar, cast

from fogbench.bench.reading.page import blocks
from fogbench.bench.reading.plugins import PluginError, load, load_conditions, load_kind, target
from fogbench.bench.reading.tables import FAMILY, KIND, Table
from fogbench.worlds.mistake import Unavailable, near
from fogbench.worlds.reading.blocks import Block, raised, read_block
from fogbench.worlds.reading.positions import Fault, Value, join
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import MapFamily

Answer = TypeVar("Answer")

Wrong = Callable[[str, str], Fault]
"""From what was expected, and the nearest name, to a fault."""


class Finder:
    """Finds what the names of a page stand for, and reads their blocks; what is wrong is added to its faults."""

    def __init__(self, folder: Path) -> None:
        """Plug-ins and map files are relative to `folder`."""
        self.folder = folder
        self.around: dict[str, Any] = {"folder": folder}
        self.faults: list[Fault] = []
        self.meant: set[str] = set()  # names in place of which unknown ones stand
        self.skipped = ""  # why worlds cannot be made here

    def block(self, settings: type[Block], value: Value) -> Block | None:
        """A block of the page."""
        return read_block(settings, value, self.around, self.faults)

    def asked(self, question: Callable[[], Answer], otherwise: Answer, wrong: Wrong) -> Answer:
        """What settings of a user's answer; what they raise is a fault."""
        try:
            return question()
        except Exception as error:  # noqa: BLE001  a user's class may raise anything
            self.faults.append(wrong(f"settings that can be asked; they raise {raised(error)}", ""))
            return otherwise

    def named(self, item: Value, expected: str) -> tuple[str, Value, Wrong] | None:
        """A name, its settings, and what tells that the name is wrong; None where that is not what stands there."""
        if isinstance(item.content, str):
            return item.content, replace(item, content={}, path=join(item.path, item.content)), item.wrong
        if len(item.fields()) == 1:
            ((name, block),) = item.fields().items()
            return name, opened(block), partial(item.wrong_key, name)
        self.faults.append(item.wrong(expected))
        return None

    def find(self, table: Table, name: str, wrong: Wrong) -> tuple[str, type[Settings] | None, str]:
        """Where the class of a plug-in is, the class, and which package it lacks.

        A name that is not known is read as the one that was meant, so that what is wrong below it is told as well.
        """
        try:
            place = target(table, name, self.folder)
        except PluginError as error:
            self.faults.append(wrong(str(error), error.near))
            self.meant.add(error.near)
            return self.find(table, error.near, wrong) if error.near else ("", None, "")
        try:
            return place, load(table, name, place), ""
        except PluginError as error:
            self.faults.append(wrong(str(error), error.near))
            return place, None, ""
        except Unavailable as error:
            return place, None, str(error)

    def family_class(self, page: Value) -> tuple[type[Settings], Value] | None:
        """The class of a page's map family and its block; None where there is none, or it lacks a package."""
        maps = page.child("maps")
        if maps is None or not isinstance(maps.content, dict):
            return None
        if len(maps.content) != 1:
            several = maps.base if maps.base and len(maps.base.fields()) != 1 else maps
            self.faults.append(several.wrong("a mapping with one map family"))
            return None
        ((name, block),) = maps.content.items()
        _, found, missing = self.find(FAMILY, name, partial(maps.wrong_key, name))
        self.skipped = f"{name} {missing}" if missing else ""
        return (found, opened(block)) if found else None

    def kind_class(self, page: Value, family: type[Settings] | None) -> tuple[str, type[Settings] | None]:
        """The kind of worlds that a page is about, and the class of its conditions, if it is at hand.

        A family that cannot be found is taken for one of the first kind, so that the rest of the page is read.
        """
        possible = cast(MapFamily, family).kinds if family else tuple(KIND.targets())
        if not (isinstance(possible, tuple) and possible and all(isinstance(kind, str) for kind in possible)):
            told = f"a map family whose kinds are a tuple of names; this one has {possible!r}"
            self.faults.append(of_family(page, told))
            return "", None
        said = page.child("kind")
        name = str(said.content) if said and said.content and not said.unset else possible[0]
        if self.skipped:  # of a family that is missing, nobody knows the kind
            return name, None
        try:
            kind = load_kind(name)
            if said and not {name, kind.maps} & set(possible):
                told = f"a kind that these maps can be: {' or '.join(possible)}"
                self.faults.append(said.wrong(told, near(name, possible)))
            return name, load_conditions(name, kind)
        except PluginError as error:
            told = f"a map family of the kind {' or '.join(KIND.targets())}; this one is of {name!r}"
            unknown = of_family(page, told if name not in KIND.targets() else str(error))
            self.faults.append(said.wrong(str(error), error.near) if said else unknown)
        except Unavailable as error:
            self.skipped = f"{name} {error}"
        return name, None


def of_family(page: Value, expected: str, _near: str = "") -> Fault:
    """What is wrong with the map family of a page, at its name."""
    maps = page.fields().get("maps")
    return maps.wrong_key(next(iter(maps.fields())), expected) if maps and maps.fields() else page.wrong(expected)


def opened(block: Value) -> Value:
    """A block; nothing at all stands for no settings."""
    return block if block.content is not None else replace(block, content={})


def blocks_of(page: Value, folder: Path) -> tuple[str, ...] | None:
    """The blocks that the kind of a page reads; None where its package is missing, and nobody knows them.

    Mistakes are told when the page itself is read.
    """
    finder = Finder(folder)
    family = finder.family_class(page)
    _, conditions = finder.kind_class(page, family[0] if family else None)
    return None if finder.skipped else blocks(conditions)
