"""A recipe: one YAML file with a scenario's keys for its worlds, a network, and how it learns."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

from pydantic import Field

from fogbench.bench.reading.finding import blocks_of, opened
from fogbench.bench.reading.overlays import pages, settle
from fogbench.bench.reading.page import FileName
from fogbench.bench.reading.plugins import load
from fogbench.bench.reading.scenario import wrong
from fogbench.bench.reading.tables import LEARNER, NETWORK, Table
from fogbench.bench.reading.worlds import Reading
from fogbench.learned.training.recipe import Learner, Lesson, Recipe, Validation, Worlds
from fogbench.worlds.mistake import Mistake, near, one_of
from fogbench.worlds.reading.document import parse
from fogbench.worlds.reading.positions import Fault, Value, merge
from fogbench.worlds.settings import Seed, Settings
from fogbench.worlds.types import MapFamily

if TYPE_CHECKING:
    from fogbench.learned.policy import Policy

VARIED = ("maps", "kind")
"""Keys that a variant may have, beside the blocks of its kind."""

ELSEWHERE = {"seed": "the recipe's own seed, which fixes the weights too", "device": "--device on the command line"}
"""Settings of a network that a recipe does not give with it."""


class RecipePage(Settings):
    """A recipe: a network, the worlds where it learns, and how."""

    name: FileName
    """Its name, and that of the checkpoint."""
    about: str = ""
    """One sentence."""
    network: dict[str, Any] | str
    """A learned policy with its settings; a `checkpoint` among them is where it starts from."""
    maps: dict[str, Any]
    """One map family with its settings."""
    kind: str | None = None
    """Kind of the worlds on these maps; by default the first that the family can make."""
    learning: dict[str, Any]
    """One way to learn, with its settings."""
    validation: Validation = Validation()
    """How the network is tried while it learns."""
    variants: Annotated[dict[str, dict[str, Any] | None], Field(default_factory=dict)]
    """Where the network is tried while it learns: named changes to the recipe's worlds; by default those worlds."""
    lessons: Annotated[list[str], Field(default_factory=list)]
    """Variants on which it learns, by turns; by default the recipe's own worlds."""
    seed: Seed = 0
    """Fixes the first weights, the maps to learn on and all luck; the maps it is tried on are the same for all."""


Here = Reading[RecipePage]
"""What one page of a recipe says: the whole, or a variant laid over it."""


def read_recipe(text: str, path: Path) -> Recipe:
    """Read the text of a recipe.

    Args:
        text: the YAML.
        path: where it came from; plug-ins, checkpoints and map files are relative to its folder.

    Raises:
        ScenarioError: all the mistakes of the file.
        Mistake: an environment variable in it is not set.
    """
    faults: list[Fault] = []
    page = parse(text, faults)
    if page is None:
        raise wrong(faults, path)
    if other := _other(page):
        raise wrong([other], path)
    read = _read(page, path.parent, faults)
    if faults:
        raise wrong(faults, path)
    if unset := next((value.unset for value in page.below() if value.unset), ""):
        raise Mistake(f"{path}: got ${{{unset}}}; expected that environment variable to be set.")
    return _recipe(text, path, *read)


Readings = tuple[Here, dict[str, Here], list[tuple[Here, MapFamily | None]]]
"""The page, its variants, and the lessons with their maps at first."""


def _read(page: Value, folder: Path, faults: list[Fault]) -> tuple[Readings, "Policy | None", Learner | None]:
    """All that a page says; what is wrong with it is added to `faults`."""
    rows = pages(page, faults, VARIED, partial(blocks_of, folder=folder))
    whole = Reading(RecipePage, page, folder)
    variants = {name: Reading(RecipePage, row, folder) for name, row in rows.items()}
    network, learning = _network(whole, page.child("network")), _learning(whole, page.child("learning"))
    pairs = [(variants[name], rows[name]) for name in _names(whole, page.child("lessons"), rows)] or [(whole, page)]
    lessons = [(reading, _easy(reading, lesson)) for reading, lesson in pairs]
    faults += settle([whole.faults, *(variant.faults for variant in variants.values())])
    return (whole, variants, lessons), network, learning


def _recipe(text: str, path: Path, readings: Readings, network: "Policy | None", learning: Learner | None) -> Recipe:
    """A recipe of which everything could be read.

    Raises:
        Mistake: there is nothing to learn on here, or the network does not play there.
    """
    whole, variants, lessons = readings
    assert network is not None
    for reading in (whole, *variants.values()):
        _refuse(reading, network, path)
    assert whole.page is not None
    assert learning is not None
    return Recipe(
        name=whole.page.name,
        about=whole.page.about,
        text=text,
        network=network.model_copy(update={"seed": whole.page.seed}),
        lessons=tuple(Lesson(_worlds(reading), cast(MapFamily, easy)) for reading, easy in lessons),
        held_out={name: _worlds(variant) for name, variant in variants.items()},
        learning=learning,
        validation=whole.page.validation,
        seed=whole.page.seed,
    )


def _refuse(reading: Here, network: "Policy", path: Path) -> None:
    """Nothing is learned from worlds that cannot be made here, or that the network does not play.

    Raises:
        Mistake: it is so.
    """
    if reading.skipped:
        raise Mistake(f"{path}: maps: {reading.skipped}.")
    if reading.kind not in network.kinds:
        plays = f"one that plays worlds of kind {reading.kind}"
        raise Mistake(f"{path}: network: got one that plays {', '.join(sorted(network.kinds))}; expected {plays}.")


def _other(page: Value) -> Fault | None:
    """That a page is a scenario, or has a setting of a learner beside the keys of a recipe, as all had once."""
    if "agents" in page.fields() and "network" not in page.fields():
        return page.wrong_key("agents", "a recipe, with a network; a scenario is for `fogbench run`")
    for name, place in LEARNER.shipped.items():
        for key in page.fields():
            if key in load(LEARNER, name, place).model_fields and key not in RecipePage.model_fields:
                return page.wrong_key(key, f"learning: {{{name}: {{{key}: ...}}}}", "learning")
    return None


def _network(reading: Here, item: Value | None) -> "Policy | None":
    """The network that a page names, with fresh weights unless it says others."""
    if item is None or not isinstance(item.content, str | dict):
        return None
    found = _found(reading, item, NETWORK, "network")
    if found is None:
        return None
    settings, block = found
    reading.faults += [block.wrong_key(key, told) for key, told in ELSEWHERE.items() if key in block.fields()]
    own = {key: value for key, value in block.fields().items() if key not in ELSEWHERE}
    fresh = {"checkpoint": replace(block, content="none")}
    return cast("Policy | None", reading.block(settings, replace(block, content=fresh | own)))


def _learning(reading: Here, item: Value | None) -> Learner | None:
    """How the network learns, as a page says it."""
    if item is None or not isinstance(item.content, dict):
        return None
    found = _found(reading, item, LEARNER, "learner")
    return cast(Learner | None, reading.block(*found)) if found else None


def _found(reading: Here, item: Value, table: Table, noun: str) -> tuple[type[Settings], Value] | None:
    """The class that an item names, and its block; a training cannot do without it."""
    named = reading.named(item, f"the name of a {noun}, or one name with its settings")
    if named is None:
        return None
    name, block, wrong_name = named
    _, found, missing = reading.find(table, name, wrong_name)
    if missing:
        reading.faults.append(wrong_name(f"a {noun} that is installed; this one {missing}", ""))
    return (found, block) if found else None


def _names(reading: Here, lessons: Value | None, rows: dict[str, Value]) -> list[str]:
    """The variants that are lessons."""
    items = lessons.content if lessons and isinstance(lessons.content, list) else []
    names = [item for item in items if isinstance(item.content, str) and not item.unset]
    unknown = [item for item in names if item.content not in rows]
    reading.faults += [item.wrong(one_of(rows), near(str(item.content), rows)) for item in unknown]
    return [str(item.content) for item in names if item not in unknown]


def _easy(reading: Here, lesson: Value) -> MapFamily | None:
    """The maps of a lesson's page with the curriculum's first settings; without a curriculum, as they are."""
    learning, maps = lesson.child("learning"), lesson.child("maps")
    blocks = list(learning.fields().values()) if learning else []
    curriculum = blocks[0].child("curriculum") if blocks else None
    easy = curriculum.child("easy") if curriculum else None
    if maps is None or easy is None or reading.family is None:
        return reading.family
    (block,) = maps.fields().values()
    return cast(MapFamily | None, reading.block(type(reading.family), merge(opened(block), easy)))


def _worlds(reading: Here) -> Worlds:
    assert reading.family is not None
    return Worlds(reading.family, cast(Any, reading.conditions))
