"""What all settings share: frozen, nothing unknown allowed, and the few types their fields are made of."""

from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationInfo


class Settings(BaseModel):
    """A block of a scenario: frozen, hashable, and closed to fields it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True)

    def words(self) -> str:
        """All that fixes what these settings make, as text; of a file the contents count, not the place."""
        return f"{type(self).__name__} {self.model_dump_json()}"


def _ascending(bounds: tuple[int, int]) -> tuple[int, int]:
    if bounds[0] > bounds[1]:
        raise ValueError("two numbers, the smaller first")
    return bounds


Count = Annotated[int, Field(ge=0)]
"""A whole number from 0."""

Positive = Annotated[int, Field(ge=1)]
"""A whole number from 1."""

Probability = Annotated[float, Field(ge=0, le=1)]
"""A number from 0 to 1."""

Range = Annotated[tuple[Count, Count], AfterValidator(_ascending)]
"""`[least, most]`, both included, from 0."""

PositiveRange = Annotated[tuple[Positive, Positive], AfterValidator(_ascending)]
"""`[least, most]`, both included, from 1."""


def whole(path: str | Path, info: ValidationInfo) -> Path:
    """The whole path of a file that a block names.

    A relative one starts at the scenario's folder (validation context `folder`); one that an environment variable was
    filled into (`filled`), where the user stands.
    """
    context = info.context or {}
    folder = Path() if Path(path) in context.get("filled", ()) else context.get("folder", Path())
    return Path(folder, path).absolute()


def _locate(path: Path, info: ValidationInfo) -> Path:
    if not info.context:
        return path
    place = whole(path, info)
    if not place.exists():
        raise ValueError(f"an existing file (looked for {place})")
    return place


MapFile = Annotated[Path, AfterValidator(_locate)]
"""A file, its path made `whole`; in a scenario it must exist."""
