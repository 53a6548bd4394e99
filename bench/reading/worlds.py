"""What scenarios and recipes have in common: a map family, the conditions on it, classes by their names."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Generic, TypeVar, cast

from fogbench.bench.reading.blocks import Block, read_block
from fogbench.bench.reading.page import CONDITIONS
from fogbench.bench.reading.plugins import PluginError, load, target
from fogbench.bench.reading.positions import Fault, Value, join
from fogbench.bench.reading.tables import FAMILY, KIND, Table
from fogbench.worlds.mistake import Unavailable
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import MapFamily

Keys = TypeVar("Keys", bound=Settings)

Wrong = Callable[[str, str], Fault]
"""From what was expected, and the nearest name, to a fault."""


class Reading(Generic[Keys]):
    """What a page says; whatever is wrong with one part of it, the others are read too."""

    def __init__(self, keys: type[Keys], page: Value, folder: Path) -> None:
        """Read a page whose keys are those of a class; plug-ins and map files are relative to `folder`."""
        self.folder = folder
        self.around: dict[str, Any] = {"folder": folder}
        self.faults: list[Fault] = []
        self.meant: set[str] = set()  # names in place of which unknown ones stand
        self.page = self.block(keys, page)
        self.kind = "grid"  # a family that cannot be found is taken for one of grids
        self.family = self._family(page.child("maps"))
        self.around["extent"] = self.family.extent() if self.family else None
        self.conditions = self._conditions(page)

    def _family(self, maps: Value | None) -> MapFamily | None:
        if maps is None or not isinstance(maps.content, dict):
            return None
        if len(maps.content) != 1:
            several = maps.base if maps.base and len(maps.base.fields()) != 1 else maps
            self.faults.append(several.wrong("a mapping with one map family"))
            return None
        ((name, block),) = maps.content.items()
        wrong = partial(maps.wrong_key, name)
        _, found, missing = self.find(FAMILY, name, wrong)
        if missing:
            self.faults.append(wrong(f"a map family that is installed; this one {missing}"))
        if found is None:
            return None
        kind = cast(MapFamily, found).kind
        if kind in KIND.shipped:
            self.kind = kind
        else:
            self.faults.append(wrong(f"a map family of the kind {' or '.join(KIND.shipped)}; this one is of {kind!r}"))
        return cast(MapFamily | None, self.block(found, opened(block)))

    def _conditions(self, page: Value) -> Settings | None:
        fields = {key: value for key, value in page.fields().items() if key in CONDITIONS}
        found = load(KIND, self.kind, KIND.shipped[self.kind])
        return self.block(found, replace(page, content=fields))

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

    def block(self, settings: type[Block], value: Value) -> Block | None:
        """A block of the page."""
        return read_block(settings, value, self.around, self.faults)


def opened(block: Value) -> Value:
    """A block; nothing at all stands for no settings."""
    return block if block.content is not None else replace(block, content={})
