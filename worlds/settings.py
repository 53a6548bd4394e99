"""What all settings share: frozen, nothing unknown allowed, and the few types their fields are made of."""

import os
from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationInfo


class Settings(BaseModel):
    """A block of a scenario: frozen, hashable, and closed to fields it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True)

    def words(self) -> str:
        """All that fixes what these settings make, as text; of a file the contents count, not the place."""
        return f"{type(self).__name__} {self.model_dump_json()}"


def ascending(bounds: tuple[int, int]) -> tuple[int, int]:
    """The same two numbers.

    Raises:
        ValueError: the larger comes first.
    """
    if bounds[0] > bounds[1]:
        raise ValueError("two numbers, the smaller first")
    return bounds


MOST = 1_000_000_000
"""No whole number of a file is larger; 32 bits hold it, and twice as much."""

SIDE = 4096
"""Cells in a row of a drawn map at most; a map of 16 million cells takes some hundred megabytes while it is drawn."""

Count = Annotated[int, Field(ge=0, le=MOST)]
"""A whole number from 0 to a billion."""

Positive = Annotated[int, Field(ge=1, le=MOST)]
"""A whole number from 1 to a billion."""

Seed = Annotated[int, Field(ge=0, le=2**32 - 1)]
"""Of all luck; 32 bits."""

Probability = Annotated[float, Field(ge=0, le=1)]
"""A number from 0 to 1."""

Range = Annotated[tuple[Count, Count], AfterValidator(ascending)]
"""`[least, most]`, both included, from 0 to a billion."""

PositiveRange = Annotated[tuple[Positive, Positive], AfterValidator(ascending)]
"""`[least, most]`, both included, from 1 to a billion."""


def whole(path: str | Path, info: ValidationInfo) -> Path:
    """The whole path of a file that a block names.

    A relative one starts at the scenario's folder (validation context `folder`); one that an environment variable was
    filled into (`filled`), where the user stands.
    """
    context = info.context or {}
    folder = Path() if Path(path) in context.get("filled", ()) else context.get("folder", Path())
    return Path(folder, path).absolute()


LONGEST = 300
"""Letters of a path that an error shows at most."""


def _locate(path: Path, info: ValidationInfo) -> Path:
    if not info.context:
        return path
    place = whole(path, info)
    if not os.path.exists(place):  # noqa: PTH110  it takes any path, however long
        looked = str(place) if len(str(place)) <= LONGEST else f"{str(place)[:LONGEST]}..."
        raise ValueError(f"an existing file (looked for {looked})")
    return place


MapFile = Annotated[Path, AfterValidator(_locate)]
"""A file, its path made `whole`; in a scenario it must exist."""
