"""The keys of a scenario file: its own, and the blocks that the kind of its worlds reads."""

import re
from functools import cache
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, create_model

from fogbench.worlds.settings import Seed, Settings

LONGEST = 100
"""Characters of a name at most: names of files are made of it."""

NAME = f"a name of 1 to {LONGEST} characters that can be printed"

DEVICES = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
"""Names that Windows keeps for itself."""


def is_name(text: str) -> bool:
    """Whether a text is short enough for a name, can be printed, and is not blank."""
    return 0 < len(text) <= LONGEST and text.isprintable() and not text.isspace()


def _file_name(name: str) -> str:
    edges = name.startswith((".", " ")) or name.endswith((".", " "))
    if not is_name(name) or set(name) & set('/\\:*?"<>|') or edges or DEVICES.fullmatch(name):
        raise ValueError(f"a name that a folder can have, of at most {LONGEST} characters")
    return name


FileName = Annotated[str, AfterValidator(_file_name)]
"""A name that a file or a folder can have."""


def _infinity(number: Any) -> Any:
    return "inf" if number == ".inf" else number  # as YAML writes it


EPISODES = 1_000_000
"""Of one agent in one variant at most."""

Number = Annotated[float, Field(ge=0, allow_inf_nan=True), BeforeValidator(_infinity)]
"""A number from 0; `.inf` is one."""

Percent = Annotated[float, Field(ge=0, le=100)]
Share = Annotated[float, Field(ge=0, le=1)]

N = TypeVar("N")
By = Annotated[dict[str, dict[str, N]], Field(default_factory=dict)]
"""Numbers by the agent's label and the variant's name."""


class Open(Settings):
    """A page that may have any key."""

    model_config = ConfigDict(extra="allow")


class Published(Settings):
    """Numbers to print beside the measured ones, by the name of the metric."""

    source: str
    """Where they were published."""
    success: By[Percent]
    """Share of episodes that end at the goal [%]: `{AGENT: {VARIANT: 96.3}}`, as all that follow."""
    path_ratio: By[Number]
    """Path length over the optimum's."""
    reference_ratio: By[Number]
    """Path length over that of a reference agent."""
    test_error: By[Share]
    """Share of wrong decisions, from 0 to 1."""


class Page(Settings):
    """A scenario: maps, the conditions on them, and the agents that meet there."""

    name: FileName
    """Its name in tables, and of the folder of its results."""
    about: str = ""
    """One sentence."""
    maps: dict[str, Any]
    """One map family with its settings."""
    kind: str | None = None
    """Kind of the worlds on these maps; by default the first that the family can make."""
    variants: Annotated[dict[str, dict[str, Any] | None], Field(default_factory=dict)]
    """Name to what differs from the rest: mappings merge, lists and scalars replace. Each is a row of the tables."""
    agents: Annotated[list[Any], Field(min_length=1)]
    """Names, or `name: settings` where it has any; `label` among the settings renames it in tables."""
    reference: str | None = None
    """Label of the agent that all others are tested against, paired by episode; by default the first."""
    episodes: Annotated[int, Field(ge=1, le=EPISODES)]
    """Episodes for each variant and agent."""
    seed: Seed = 0
    """Fixes all luck; another seed, other maps."""
    published: Published | None = None


VARIED = tuple(key for key in Page.model_fields if key not in ("name", "about", "variants", "published"))
"""Keys that a variant may have, beside the blocks of its kind."""


def blocks(conditions: type[Settings] | None) -> tuple[str, ...]:
    """The keys of a page that a kind of world reads: the fields of its conditions; none of a kind that is missing."""
    return tuple(conditions.model_fields) if conditions else ()


@cache
def with_blocks(keys: type[Settings], conditions: type[Settings] | None) -> type[Settings]:
    """The keys of a page with the blocks of a kind of world after `kind`, where anything may stand.

    Of a kind that is missing nobody knows the blocks, so any key may stand there.
    """
    fields: dict[str, Any] = {}
    for key, field in keys.model_fields.items():
        fields[key] = (field.annotation, field)
        if key == "kind":
            fields |= dict.fromkeys(blocks(conditions), (Any, None))
    return create_model(keys.__name__, __base__=Settings if conditions else Open, __doc__=keys.__doc__, **fields)
