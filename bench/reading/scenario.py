"""A scenario: one YAML file, read into worlds to sample and agents to start."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from fogbench.bench.reading.finding import blocks_of
from fogbench.bench.reading.named_files import named_files
from fogbench.bench.reading.overlays import pages, settle, unknown_variants
from fogbench.bench.reading.page import VARIED
from fogbench.bench.reading.variant import Entry, VariantReading
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.reading.document import parse
from fogbench.worlds.reading.positions import Fault, Value, told
from fogbench.worlds.types import MapFamily

LARGEST = 1_000_000
"""Letters of a page at most; PyYAML takes some ten seconds for as many."""


@dataclass(frozen=True, slots=True, eq=False)
class Variant:
    """One row of a scenario's tables."""

    name: str
    kind: str
    """A name of `fogbench.worlds.KINDS`, or of a kind that another package adds."""
    family: MapFamily
    conditions: Any
    """An object of the class that its kind names."""
    agents: tuple[Entry, ...]
    reference: str
    """Label of the agent that all others are tested against, paired by episode."""
    episodes: int
    seed: int
    files: tuple[Path, ...] = ()
    """That the settings of its map family name."""
    place: str = ""
    """Where its maps are said: `file:line:column  path`."""


@dataclass(frozen=True, slots=True, eq=False)
class Scenario:
    """One file."""

    path: Path
    text: str
    name: str
    about: str
    variants: tuple[Variant, ...]
    published: dict[str, Any]
    """`{"source": ..., metric: {agent label: {variant: number}}}`; empty if nothing was published."""
    skipped: str
    """Why none of it runs here (a map file's environment variable is not set); empty if it does."""
    left_out: Mapping[str, str] = field(default_factory=dict)
    """Why some of its variants cannot be played here (a package is missing), by their names."""


class ScenarioError(Mistake):
    """A file with mistakes; `lines` has one `file:line:column  path: got X; expected Y.` for each, in order."""

    def __init__(self, lines: list[str], rest: Scenario | None = None) -> None:
        """Collect the lines; `rest` has the variants whose worlds can be made all the same."""
        super().__init__("\n".join(lines))
        self.lines = lines
        self.rest = rest


def text_of(path: Path) -> str:
    """The text of a file; a byte order mark is no part of it.

    Raises:
        ScenarioError: it cannot be read, or is larger than any page.
    """
    try:
        with path.open(encoding="utf-8-sig") as file:
            text = file.read(LARGEST + 1)  # a device may have no end
    except (OSError, UnicodeDecodeError) as error:
        raise ScenarioError([f"{path}: got a file that cannot be read ({error}); expected UTF-8 text."]) from None
    if len(text) > LARGEST:
        raise ScenarioError([f"{path}: got a file of more letters; expected at most {LARGEST:,}."])
    return text


def read_scenario(text: str, path: Path) -> Scenario:
    """Read the text of a scenario file.

    Args:
        text: the YAML.
        path: where it came from; plug-ins and map files are relative to its folder.

    Raises:
        ScenarioError: all the mistakes of the file.
    """
    faults: list[Fault] = []
    page = parse(text, faults)
    if page is None:
        raise wrong(faults, path)
    whole = pages(page, faults, VARIED, partial(blocks_of, folder=path.parent))
    rows = {name: VariantReading(row, path.parent) for name, row in whole.items()}
    faults += settle([row.faults for row in rows.values()]) + unknown_variants(page, list(rows))
    name, about = (str(value.content) if (value := page.child(key)) else "" for key in ("name", "about"))
    published = next(iter(rows.values())).published
    unset = next((value.unset for value in page.below() if value.unset), "")
    left_out = {name: row.skipped for name, row in rows.items() if row.skipped}
    whole_rows = {name: row for name, row in rows.items() if row.family and row.conditions and not unset}
    variants = tuple(_variant(name, row, _place(path, whole[name])) for name, row in whole_rows.items())
    missing = f"environment variable {unset} is not set" if unset else next(iter(left_out.values()), "")
    skipped = "" if variants else missing
    scenario = Scenario(path, text, name, about, variants, published, skipped, {} if unset else left_out)
    if faults:
        raise wrong(faults, path, scenario)
    return scenario


def wrong(faults: list[Fault], path: Path, rest: Scenario | None = None) -> ScenarioError:
    """All that is wrong with a file, in order and once."""
    return ScenarioError(told(faults, str(path)), rest)


def _place(path: Path, page: Value) -> str:
    """Where the map family of a page stands."""
    (family,) = page.fields()["maps"].fields().values()
    return f"{path}:{family.key.line}:{family.key.column}  {family.path}"


def _variant(name: str, row: VariantReading, place: str) -> Variant:
    """A variant whose worlds can be made."""
    assert row.family is not None
    page, labels = row.page, [entry.label for entry in row.agents]
    reference = page.reference if page and page.reference else next(iter(labels), "")
    episodes, seed = (page.episodes, page.seed) if page else (1, 0)  # of a page with mistakes nothing is recorded
    terms = episodes, seed, named_files(row.family, row.folder), place
    return Variant(name, row.kind, row.family, row.conditions, row.agents, reference, *terms)
