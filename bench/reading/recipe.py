"""A recipe: one YAML file with a scenario's keys for its worlds, a network, and how it is trained."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

from pydantic import Field

from fogbench.bench.reading.document import parse
from fogbench.bench.reading.finding import blocks_of, opened
from fogbench.bench.reading.overlays import pages, settle
from fogbench.bench.reading.page import FileName
from fogbench.bench.reading.positions import Fault, Value, merge
from fogbench.bench.reading.scenario import wrong
from fogbench.bench.reading.tables import NETWORK
from fogbench.bench.reading.worlds import Reading
from fogbench.learned.training.recipe import Lesson, Recipe, Training, Worlds
from fogbench.worlds.mistake import Mistake, near, one_of
from fogbench.worlds.types import MapFamily

if TYPE_CHECKING:
    from fogbench.learned.policy import Policy

VARIED = ("maps", "kind")
"""Keys that a variant may have, beside the blocks of its kind."""

ELSEWHERE = {"seed": "the recipe's own seed, which fixes the weights too", "device": "--device on the command line"}
"""Settings of a network that a recipe does not give with it."""


class RecipePage(Training):
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
    variants: Annotated[dict[str, dict[str, Any] | None], Field(default_factory=dict)]
    """Where the network is tried while it learns: name to what differs from the rest; by default the rest itself."""
    lessons: Annotated[list[str], Field(default_factory=list)]
    """Variants on which it learns, by turns; by default it learns on the rest itself."""


class LessonReading(Reading[RecipePage]):
    """What a page says of worlds to learn on."""

    def __init__(self, page: Value, folder: Path) -> None:
        """Read a page; plug-ins, checkpoints and map files are relative to `folder`."""
        super().__init__(RecipePage, page, folder)
        curriculum = page.child("curriculum")
        self.easy = self._easy(page.child("maps"), curriculum.child("easy") if curriculum else None)

    def _easy(self, maps: Value | None, easy: Value | None) -> MapFamily | None:
        """The family with the settings of the curriculum's beginning; without a curriculum, the family."""
        if maps is None or easy is None or self.family is None:
            return self.family
        (block,) = maps.fields().values()
        return cast(MapFamily | None, self.block(type(self.family), merge(opened(block), easy)))


class RecipeReading(LessonReading):
    """What the page of a recipe says, and those of the variants on which the network learns."""

    def __init__(self, page: Value, variants: dict[str, Value], folder: Path) -> None:
        """Read a page, and which of its variants are lessons; without any, the page itself is the one lesson."""
        super().__init__(page, folder)
        network, lessons = page.child("network"), page.child("lessons")
        self.network = self._network(network) if network and isinstance(network.content, str | dict) else None
        named = self._lessons(lessons.content if lessons and isinstance(lessons.content, list) else [], variants)
        self.lessons = [LessonReading(lesson, folder) for lesson in named] or [self]
        self.faults += [fault for lesson in self.lessons if lesson is not self for fault in lesson.faults]

    def _lessons(self, items: list[Value], variants: dict[str, Value]) -> list[Value]:
        for item in items:
            if isinstance(item.content, str) and item.content not in variants and not item.unset:
                self.faults.append(item.wrong(one_of(variants), near(item.content, variants)))
        return [variants[str(item.content)] for item in items if str(item.content) in variants]

    def _network(self, item: Value) -> "Policy | None":
        named = self.named(item, "the name of a network, or one name with its settings")
        if named is None:
            return None
        name, block, wrong_name = named
        _, found, missing = self.find(NETWORK, name, wrong_name)
        if missing:
            self.faults.append(wrong_name(f"a network that is installed; this one {missing}", ""))
        if found is None:
            return None
        self.faults += [block.wrong_key(key, told) for key, told in ELSEWHERE.items() if key in block.fields()]
        own = {key: value for key, value in block.fields().items() if key not in ELSEWHERE}
        fresh = {"checkpoint": replace(block, content="none")}
        return cast("Policy | None", self.block(found, replace(block, content=fresh | own)))


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
    rows = pages(page, faults, VARIED, partial(blocks_of, folder=path.parent))
    recipe = RecipeReading(page, rows, path.parent)
    variants = {name: Reading(RecipePage, row, path.parent) for name, row in rows.items()}
    faults += settle([recipe.faults, *(variant.faults for variant in variants.values())])
    if faults:
        raise wrong(faults, path)
    if unset := next((value.unset for value in page.below() if value.unset), ""):
        raise Mistake(f"{path}: got ${{{unset}}}; expected that environment variable to be set.")
    return _recipe(text, recipe, variants)


def _recipe(text: str, recipe: RecipeReading, variants: dict[str, Reading[RecipePage]]) -> Recipe:
    """A recipe of which everything could be read."""
    page = recipe.page
    assert page is not None
    assert recipe.network is not None
    training = Training(**{name: getattr(page, name) for name in Training.model_fields})
    return Recipe(
        name=page.name,
        about=page.about,
        text=text,
        network=recipe.network.model_copy(update={"seed": training.seed}),
        lessons=tuple(Lesson(_worlds(lesson), cast(MapFamily, lesson.easy)) for lesson in recipe.lessons),
        held_out={name: _worlds(variant) for name, variant in variants.items()},
        training=training,
    )


def _worlds(reading: Reading[RecipePage]) -> Worlds:
    assert reading.family is not None
    return Worlds(reading.family, cast(Any, reading.conditions))
