"""The reading of one variant: its map family, its conditions, its agents."""

from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

from fogbench.bench.reading.named_files import named_files
from fogbench.bench.reading.page import NAME, Page, is_name
from fogbench.bench.reading.tables import AGENT
from fogbench.bench.reading.worlds import Reading
from fogbench.worlds.mistake import near, one_of
from fogbench.worlds.reading.positions import Fault, Value
from fogbench.worlds.types import AgentSettings

NOWHERE = Fault(1, 1, "", "", "")
"""The place of an agent that no file names."""


@dataclass(frozen=True, slots=True, eq=False)
class Entry:
    """One agent of a variant."""

    label: str
    """Its name in tables; unique in its variant."""
    target: str
    """Where its class is: `module:class`, or `/absolute/file.py:class` for a plug-in."""
    settings: AgentSettings | None
    skipped: str
    """Why it does not run here; empty if it does."""
    named: Fault = NOWHERE
    """Where it is named; whoever finds something wrong with it says what was expected there."""
    files: tuple[Path, ...] = ()
    """That its settings name."""


class VariantReading(Reading[Page]):
    """What the page of a variant says."""

    def __init__(self, page: Value, folder: Path) -> None:
        """Read a page; plug-ins and map files are relative to `folder`."""
        super().__init__(Page, page, folder)
        self.lines: dict[str, int] = {}  # of the agents' labels
        self.agents = self._agents(page.child("agents"))
        self._check_reference(page.child("reference"))

    @property
    def published(self) -> dict[str, Any]:
        """The numbers to print beside the measured ones."""
        return self.page.published.model_dump(exclude_unset=True) if self.page and self.page.published else {}

    def _agents(self, agents: Value | None) -> tuple[Entry, ...]:
        items = agents.content if agents and isinstance(agents.content, list) else []
        return tuple(entry for item in items if not item.unset and (entry := self._agent(item)))

    def _agent(self, item: Value) -> Entry | None:
        named = self.named(item, "the name of an agent, or one name with its settings")
        if named is None:
            return None
        name, block, wrong = named
        label, block = self._label(name, item, block)
        place, found, missing = self.find(AGENT, name, wrong)
        if found is None:
            return Entry(label, place, None, missing, wrong("", "")) if missing else None
        settings = cast(AgentSettings | None, self.block(found, block))
        kinds = cast(AgentSettings, found).kinds
        if not (isinstance(kinds, AbstractSet) and all(isinstance(kind, str) for kind in kinds)):
            self.faults.append(wrong(f"an agent whose kinds are a frozenset of names; this one has {kinds!r}", ""))
            return None
        skipped = "" if self.kind in kinds else f"it plays {', '.join(sorted(kinds))} worlds, not {self.kind}"
        files = self.asked(lambda: named_files(settings, self.folder), None, wrong) if settings else None
        if settings is None or files is None:
            return None
        return Entry(label, place, settings, skipped, wrong("", ""), files)

    def _label(self, name: str, item: Value, block: Value) -> tuple[str, Value]:
        """The label of an agent, and its settings without it."""
        said = block.child("label")
        label = str(said.content) if said else name.rpartition(":")[2]
        if said and not isinstance(said.content, str):
            self.faults.append(said.wrong("text"))
        elif not is_name(label):
            self.faults.append((said or item).wrong(NAME))
        elif label in self.lines:
            expected = f"a label of its own ({label} is taken on line {self.lines[label]})"
            self.faults.append((said or item).wrong(expected))
        self.lines.setdefault(label, (said or item).spot.line)
        fields = {key: value for key, value in block.fields().items() if key != "label"}
        return label, replace(block, content=fields) if block.fields() else block

    def _check_reference(self, said: Value | None) -> None:
        if said is None or not isinstance(said.content, str) or said.unset or not self.lines:
            return
        if said.content not in self.meant | self.lines.keys():
            self.faults.append(said.wrong(one_of(self.lines), near(said.content, self.lines)))
