"""The reading of one variant: its map family, its conditions, its agents."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, cast

from bench.reading.blocks import Block, near, one_of, read_block
from bench.reading.page import CONDITIONS, Page
from bench.reading.plugins import PluginError, load, target
from bench.reading.positions import Fault, Value, join
from bench.reading.tables import AGENT, FAMILY, KIND, Table
from worlds.mistake import Unavailable
from worlds.settings import Settings
from worlds.types import AgentSettings, MapFamily

Wrong = Callable[[str, str], Fault]
"""From what was expected, and the nearest name, to a fault."""


class Listed(NamedTuple):
    """One agent of the list."""

    label: str
    target: str
    settings: AgentSettings | None
    skipped: str


class Reading:
    """What a page says; whatever is wrong with one part of it, the others are read too."""

    def __init__(self, page: Value, folder: Path) -> None:
        """Read a page; plug-ins and map files are relative to `folder`."""
        self.folder = folder
        self.faults: list[Fault] = []
        self.meant: set[str] = set()  # names in place of which unknown ones stand
        self.page = self._block(Page, page)
        self.kind = "grid"  # a family that cannot be found is taken for one of grids
        self.family = self._family(page.child("maps"))
        self.conditions = self._conditions(page)
        self.lines: dict[str, int] = {}  # of the agents' labels
        self.agents = self._agents(page.child("agents"))
        self._check_reference(page.child("reference"))

    @property
    def published(self) -> dict[str, Any]:
        """The numbers to print beside the measured ones."""
        return self.page.published.model_dump(exclude_unset=True) if self.page and self.page.published else {}

    def _family(self, maps: Value | None) -> MapFamily | None:
        if maps is None or not isinstance(maps.content, dict):
            return None
        if len(maps.content) != 1:
            several = maps.base if maps.base and len(maps.base.fields()) != 1 else maps
            self.faults.append(several.wrong("a mapping with one map family"))
            return None
        ((name, block),) = maps.content.items()
        wrong = partial(maps.wrong_key, name)
        _, found, missing = self._class(FAMILY, name, wrong)
        if missing:
            self.faults.append(wrong(f"a map family that is installed; this one {missing}"))
        if found is None:
            return None
        kind = cast(MapFamily, found).kind
        if kind in KIND.shipped:
            self.kind = kind
        else:
            self.faults.append(wrong(f"a map family of the kind {' or '.join(KIND.shipped)}; this one is of {kind!r}"))
        return cast(MapFamily | None, self._block(found, _opened(block)))

    def _conditions(self, page: Value) -> Settings | None:
        fields = {key: value for key, value in page.fields().items() if key in CONDITIONS}
        found = load(KIND, self.kind, KIND.shipped[self.kind])
        return self._block(found, replace(page, content=fields))

    def _agents(self, agents: Value | None) -> list[Listed]:
        items = agents.content if agents and isinstance(agents.content, list) else []
        return [listed for item in items if not item.unset and (listed := self._agent(item))]

    def _agent(self, item: Value) -> Listed | None:
        wrong: Wrong
        if isinstance(item.content, str):
            name, wrong = item.content, item.wrong
            block = replace(item, content={}, path=join(item.path, name))
        elif len(item.fields()) == 1:
            ((name, block),) = item.fields().items()
            wrong = partial(item.wrong_key, name)
        else:
            self.faults.append(item.wrong("the name of an agent, or one name with its settings"))
            return None
        label, block = self._label(name, item, _opened(block))
        place, found, missing = self._class(AGENT, name, wrong)
        if found is None:
            return Listed(label, place, None, missing) if missing else None
        try:
            settings = cast(AgentSettings | None, self._block(found, block))
        except Unavailable as lack:
            return Listed(label, place, None, str(lack))
        kinds = cast(AgentSettings, found).kinds
        skipped = "" if self.kind in kinds else f"it plays {', '.join(sorted(kinds))} worlds, not {self.kind}"
        return Listed(label, place, settings, skipped) if settings else None

    def _label(self, name: str, item: Value, block: Value) -> tuple[str, Value]:
        """The label of an agent, and its settings without it."""
        said = block.child("label")
        label = str(said.content) if said else name.rpartition(":")[2]
        if said and not isinstance(said.content, str):
            self.faults.append(said.wrong("text"))
        elif label in self.lines:
            expected = f"a label of its own ({label} is taken on line {self.lines[label]})"
            self.faults.append((said or item).wrong(expected))
        self.lines.setdefault(label, (said or item).spot.line)
        fields = {key: value for key, value in block.fields().items() if key != "label"}
        return label, replace(block, content=fields) if block.fields() else block

    def _check_reference(self, said: Value | None) -> None:
        if said is None or not isinstance(said.content, str) or said.unset:
            return
        if said.content not in self.meant | self.lines.keys():
            self.faults.append(said.wrong(one_of(self.lines), near(said.content, self.lines)))

    def _class(self, table: Table, name: str, wrong: Wrong) -> tuple[str, type[Settings] | None, str]:
        """Where the class of a plug-in is, the class, and which package it lacks.

        A name that is not known is read as the one that was meant, so that what is wrong below it is told as well.
        """
        try:
            place = target(table, name, self.folder)
        except PluginError as error:
            self.faults.append(wrong(str(error), error.near))
            self.meant.add(error.near)
            return self._class(table, error.near, wrong) if error.near else ("", None, "")
        try:
            return place, load(table, name, place), ""
        except PluginError as error:
            self.faults.append(wrong(str(error), error.near))
            return place, None, ""
        except Unavailable as error:
            return place, None, str(error)

    def _block(self, settings: type[Block], value: Value) -> Block | None:
        return read_block(settings, value, self.folder, self.faults)


def _opened(block: Value) -> Value:
    """A block; nothing at all stands for no settings."""
    return block if block.content is not None else replace(block, content={})
