"""Trained weights: a safetensors file, and beside it a card in JSON that says what they are and how they came about.

Importing this imports no torch.
"""

import json
import os
from collections.abc import Callable, Container, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BaseModel, ConfigDict, ValidationError
from safetensors import SafetensorError
from safetensors.numpy import load, save

from fogbench.learned.shapes import Shapes
from fogbench.worlds import files
from fogbench.worlds.files import sha256
from fogbench.worlds.mistake import Mistake, near, one_of, shown
from fogbench.worlds.types import Array

SHIPPED = Path(__file__).with_name("checkpoints")
"""Where the checkpoints are that go by a name alone."""

SUFFIX = ".safetensors"

NONE = "none"
"""In the place of a checkpoint: fresh weights."""


WEIGHTLESS = frozenset({"iterations", "memory_rows", "most", "masked"})
"""Settings on a card that no weight depends on."""


class Card(BaseModel):
    """What a checkpoint says of itself."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    network: str
    """The class of its settings."""
    settings: dict[str, Any]
    """Those that its weights were trained with."""
    sha256: str
    """Of the file of weights."""
    training: dict[str, Any] = {}
    """How it was made, and what it reached."""

    def recognise(self, network: str, settings: Mapping[str, Any]) -> None:
        """Compare it with a class of settings by names alone; the card of an earlier version may lack some.

        Raises:
            Mistake: it is the card of another network, or of a later version.
        """
        if self.network != network:
            raise Mistake(f"a checkpoint of {network} (this is one of {shown(self.network)})")
        if odd := sorted(self.settings.keys() - settings.keys()):
            raise Mistake(f"a checkpoint of this version (its card has {shown(odd[0])})")

    def compare(self, settings: Mapping[str, Any], given: Container[str], former: Mapping[str, Any]) -> None:
        """Compare it with the settings that were laid over it, of which some were `given`.

        A setting that the card lacks was made later; until then all networks were as its `former` value makes them.

        Raises:
            Mistake: they differ where they must not, or the card has no such values.
        """
        for name, value in sorted({**former, **self.settings}.items()):
            if settings[name] != value and name not in given:
                raise Mistake(f"a checkpoint whose card can be read ({shown(f'{name}: {value!r}')})")
            if settings[name] != value and name not in WEIGHTLESS:
                raise Mistake(f"{shown(f'{name} {value}')}, with which the checkpoint was trained")


def located(checkpoint: str, whole: Callable[[str], Path]) -> str:
    """A checkpoint by its name or by the whole path of its file.

    Args:
        checkpoint: `none`, the name of a shipped one, or a file that ends in `.safetensors`.
        whole: makes a path whole.

    Raises:
        Mistake: it is nothing of these, or there is no such file.
    """
    if not checkpoint.endswith(SUFFIX):
        names = [NONE, *sorted(file.stem for file in SHIPPED.glob(f"*{SUFFIX}"))]
        if checkpoint not in names:
            raise Mistake(f"a file that ends in {SUFFIX}, or {one_of(names)}", near(checkpoint, names))
        return checkpoint
    place = whole(checkpoint)
    if not os.path.isfile(place):  # noqa: PTH113  it takes any path
        raise Mistake(f"an existing file (looked for {place})")
    return str(place)


def place_of(checkpoint: str) -> Path:
    """The file of weights of a checkpoint that was `located`."""
    return Path(checkpoint) if checkpoint.endswith(SUFFIX) else SHIPPED / f"{checkpoint}{SUFFIX}"


def read_card(place: Path) -> Card:
    """The card beside a file of weights.

    Raises:
        Mistake: there is none, or it cannot be read.
    """
    card = place.with_suffix(".json")
    try:
        return Card.model_validate_json(files.contents(card).decode())
    except FileNotFoundError:
        raise Mistake(f"a checkpoint with its card (there is no {card.name} beside {place.name})") from None
    except ValidationError as error:
        raise Mistake(f"a checkpoint whose card can be read ({card.name}: {first_of(error)})") from None
    except (OSError, UnicodeDecodeError) as error:
        raise Mistake(f"a checkpoint whose card can be read ({card.name}: {error})") from None


def first_of(error: ValidationError) -> str:
    """The first of its mistakes."""
    detail = error.errors()[0]
    where = ".".join(map(str, detail["loc"]))
    return f"{shown(where)}: {detail['msg']}" if where else detail["msg"]


def read_weights(place: Path, digest: str, forms: Mapping[str, str]) -> dict[str, Array]:
    """The weights of a file.

    Args:
        place: the file.
        digest: of the file that its card was written for.
        forms: how each of the weights must lie there, by its name.

    Raises:
        Mistake: the file is not the one that its card was written for, or other weights are in it.
    """
    try:
        contents = files.contents(place)
    except OSError as error:
        raise Mistake(f"a checkpoint that can be read ({place.name}: {error.strerror})") from None
    if sha256(contents) != digest:
        raise Mistake(f"a checkpoint that is whole ({place.name} is not the file that its card was written for)")
    try:
        weights: dict[str, Array] = load(contents)
    except (SafetensorError, KeyError, TypeError, ValueError, OverflowError) as error:
        raise Mistake(f"a file of weights ({place.name}: {shown(str(error))})") from None
    found = {name: form(array) for name, array in weights.items()}
    for name in sorted(forms.keys() | found.keys()):
        here, there = forms.get(name, "missing"), found.get(name, "missing")
        if here != there:
            raise Mistake(
                f"a checkpoint that fits its card ({place.name}: {shown(name)} is {there} there, {here} here)"
            )
        if not np.isfinite(weights[name]).all():
            raise Mistake(f"a checkpoint of numbers ({place.name}: {shown(name)} has some that are none)")
    return weights


@lru_cache(maxsize=256)
def _held(place: Path, _changed: tuple[int, int], digest: str, forms: frozenset[tuple[str, str]]) -> None:
    read_weights(place, digest, dict(forms))


def hold_weights(place: Path, digest: str, forms: Mapping[str, str]) -> None:
    """As `read_weights`, for the mistakes alone: a file that stays as it is is read once in a process."""
    try:
        status = place.stat()
    except OSError:
        read_weights(place, digest, forms)  # which says so
        return
    _held(place, (status.st_mtime_ns, status.st_size), digest, frozenset(forms.items()))


def form(array: Any) -> str:
    """How the numbers of an array, or a tensor, lie in it: `float32 [4, 3]`."""
    return f"{str(array.dtype).removeprefix('torch.')} {list(array.shape)}"


def forms(shapes: Shapes) -> dict[str, str]:
    """The forms of weights of some shapes; their numbers are all of one type."""
    return {name: f"float32 {list(shape)}" for name, shape in shapes.items()}


def write(place: Path, network: str, settings: dict[str, Any], weights: Mapping[str, ArrayLike], training: Any) -> None:
    """Write a file of weights and its card, each whole or not at all."""
    contents = save({name: np.ascontiguousarray(array) for name, array in weights.items()})
    card = Card(network=network, settings=settings, sha256=sha256(contents), training=training)
    files.write(place, contents)
    files.write(place.with_suffix(".json"), json.dumps(card.model_dump(), indent=2).encode() + b"\n")
