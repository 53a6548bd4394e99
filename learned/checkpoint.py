"""Trained weights: a safetensors file, and beside it a card in JSON that says what they are and how they came about."""

import json
import os
from collections.abc import Callable, Container, Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError
from safetensors import SafetensorError
from safetensors.torch import load, save
from torch import Tensor, nn

from fogbench.worlds.files import put, sha256
from fogbench.worlds.mistake import Mistake, near, one_of

SHIPPED = Path(__file__).with_name("checkpoints")
"""Where the checkpoints are that go by a name alone."""

SUFFIX = ".safetensors"

NONE = "none"
"""In the place of a checkpoint: fresh weights."""


WEIGHTLESS = frozenset({"iterations", "memory_rows"})
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
        """Compare it with a class of settings by names alone.

        Raises:
            Mistake: it is the card of another network, or of another version.
        """
        if self.network != network:
            raise Mistake(f"a checkpoint of {network} (this is one of {self.network})")
        if odd := sorted(self.settings.keys() ^ settings.keys()):
            how = "has" if odd[0] in self.settings else "lacks"
            raise Mistake(f"a checkpoint of this version (its card {how} {odd[0]})")

    def compare(self, settings: Mapping[str, Any], given: Container[str]) -> None:
        """Compare it with the settings that were laid over it, of which some were `given`.

        Raises:
            Mistake: they differ where they must not, or the card has no such values.
        """
        for name, value in sorted(self.settings.items()):
            if settings[name] != value and name not in given:
                raise Mistake(f"a checkpoint whose card can be read ({name}: {value!r})")
            if settings[name] != value and name not in WEIGHTLESS:
                raise Mistake(f"{name} {value}, with which the checkpoint was trained")


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
        return Card.model_validate_json(card.read_text("utf-8"))
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
    return f"{where}: {detail['msg']}" if where else detail["msg"]


def read_weights(place: Path, card: Card, network: nn.Module) -> None:
    """Put the weights of a file into a network.

    Raises:
        Mistake: the file is not the one that its card was written for, or it does not fit the network.
    """
    try:
        contents = place.read_bytes()
    except OSError as error:
        raise Mistake(f"a checkpoint that can be read ({place.name}: {error.strerror})") from None
    if sha256(contents) != card.sha256:
        raise Mistake(f"a checkpoint that is whole ({place.name} is not the file that its card was written for)")
    try:
        weights = load(contents)
    except (SafetensorError, KeyError) as error:
        raise Mistake(f"a file of weights ({place.name}: {error})") from None
    wanted = network.state_dict()
    for name in sorted(wanted.keys() | weights.keys()):
        here, there = _told(wanted.get(name)), _told(weights.get(name))
        if here != there:
            raise Mistake(f"a checkpoint that fits its card ({place.name}: {name} is {there} there, {here} here)")
        if not weights[name].isfinite().all():
            raise Mistake(f"a checkpoint of numbers ({place.name}: {name} has some that are none)")
    network.load_state_dict(weights)


def write(place: Path, network: str, settings: dict[str, Any], weights: dict[str, Tensor], training: Any) -> None:
    """Write a file of weights and its card, each whole or not at all."""
    contents = save({name: tensor.detach().cpu().contiguous() for name, tensor in weights.items()})
    card = Card(network=network, settings=settings, sha256=sha256(contents), training=training)
    put(place, contents)
    put(place.with_suffix(".json"), json.dumps(card.model_dump(), indent=2).encode() + b"\n")


def _told(tensor: Tensor | None) -> str:
    return "missing" if tensor is None else f"{str(tensor.dtype).removeprefix('torch.')} {list(tensor.shape)}"
