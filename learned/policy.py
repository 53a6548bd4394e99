"""What the settings of all learned policies share: they find their weights, and hold them against what they say.

A setting that a scenario does not give is as in the checkpoint's card; one that it does give must be as in the card,
unless no weight depends on it (`fogbench.learned.checkpoint.WEIGHTLESS`). Reading settings imports no torch: what plays
is named by strings, and loaded by the first agent that starts.
"""

from math import prod
from pkgutil import resolve_name
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import (
    Field,
    ModelWrapValidatorHandler,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)
from pydantic_core import to_jsonable_python

from fogbench.learned import ENCODINGS, checkpoint
from fogbench.learned.checkpoint import NONE
from fogbench.learned.encoding.encoding import Encoding
from fogbench.learned.shapes import Shapes
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.settings import Seed, Settings, whole
from fogbench.worlds.tables import named, registered
from fogbench.worlds.types import Agent, Task

AGENT = "fogbench.learned.agent"
"""The module of the agent, which stands on PyTorch and on this one."""

ENCODED = "fogbench.encodings"
"""The group of entry points that name encodings."""

Size = Annotated[int, Field(ge=1, le=1024)]
"""Of a part of a network."""

LARGEST = 2**30
"""Bytes of all weights of a network of the project at most."""


class Policy(Settings):
    """A network as an agent."""

    kinds: ClassVar[frozenset[str]] = frozenset()
    """The kind of world that it plays; of several, `encoding` must say how it sees each."""
    made_of: ClassVar[str] = ""
    """The class of its network, as `module:class`; it is made of these settings alone."""

    checkpoint: Annotated[str, Field(examples=[NONE, "macn-grid", "./mine.safetensors"])]
    """The name of a shipped checkpoint, a file that ends in `.safetensors`, or `none` for fresh weights."""
    seed: Seed = 0
    """Of fresh weights."""
    device: Literal["cpu", "cuda"] = "cpu"
    """Where the network runs."""

    _weights: str = ""
    """The digest of the checkpoint's weights as they were when these settings were read."""

    def network(self) -> Any:
        """A `fogbench.learned.networks.network.Network` with weights drawn anew; by default one of `made_of`."""
        return resolve_name(self.made_of)(self)

    def shapes(self) -> Shapes | None:
        """The names and shapes of all weights of the network, of 32 bits each.

        None: these settings do not say, and the network is built to know.
        """
        return None

    def encoding(self) -> Encoding:
        """What its network sees of an episode, and what the outputs mean; by default as the kind of world has it.

        Raises:
            Mistake: its kind of world has no encoding.
        """
        (kind,) = self.kinds
        found: Any = named(ENCODINGS, ENCODED, kind)
        if found is None:
            raise Mistake(f"got a network for worlds of kind {kind}, which have no encoding")
        encoding: Encoding = found(self)
        return encoding

    def start(self, task: Task, rng: np.random.Generator) -> Agent:
        """A fresh agent; it needs no luck.

        Raises:
            Mistake: the network is not for such a task.
        """
        del rng
        agent: Agent = resolve_name(f"{AGENT}:PolicyAgent")(self, task)
        return agent

    def uses(self) -> tuple[str, ...]:
        """What plays for it and no import statement names: the module of its agent, its network and its encoding."""
        encodings = {**registered(ENCODED), **ENCODINGS}
        targets = [self.made_of, *(encodings[kind] for kind in sorted(self.kinds) if kind in encodings)]
        return AGENT, *filter(None, targets)

    def check(self, extent: tuple[float, ...] | None) -> None:
        """Hold it against the extent of all maps that it is to play on; None: they differ.

        Raises:
            Mistake: it cannot play on them.
        """

    def idle(self) -> frozenset[str]:
        """The settings that mean nothing together with the others; to give one of them another value is a mistake."""
        return frozenset()

    def parameter_bytes(self) -> int:
        """The bytes of all weights."""
        shapes = self.shapes()
        if shapes is None:
            return sum(parameter.nbytes for parameter in self._built().parameters())
        return 4 * sum(map(prod, shapes.values()))

    def words(self) -> str:
        """The settings, and the digest of the weights in place of where they are."""
        return f"{type(self).__name__} {self.model_dump_json(exclude={'checkpoint'})} weights={self._weights}"

    @field_validator("checkpoint")
    @classmethod
    def _found(cls, name: str, info: ValidationInfo) -> str:
        return checkpoint.located(name, lambda path: whole(path, info))

    @field_validator("device")
    @classmethod
    def _at_hand(cls, device: str) -> str:
        if device == "cuda":
            import torch  # noqa: PLC0415  only now is it asked

            if not torch.cuda.is_available():
                raise Mistake("cpu, for PyTorch finds no CUDA device here")
        return device

    @model_validator(mode="wrap")
    @classmethod
    def _as_trained(cls, block: Any, read: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        settings = read(block)
        if settings.checkpoint != NONE and isinstance(block, dict):
            card = checkpoint.read_card(checkpoint.place_of(settings.checkpoint))
            card.recognise(cls.__name__, settings.trained())
            try:
                settings = read(card.settings | block)
            except ValidationError as error:
                raise Mistake(f"a checkpoint whose card can be read ({checkpoint.first_of(error)})") from None
            usual = {name: field.default for name, field in cls.model_fields.items() if not field.is_required()}
            former = {name: to_jsonable_python(usual[name]) for name in settings.trained().keys() & usual.keys()}
            card.compare(settings.trained(), block, former)
            settings._weights = card.sha256  # noqa: SLF001  its own
        settings._check(info)  # noqa: SLF001  its own
        return settings

    def _check(self, info: ValidationInfo) -> None:
        """Whatever is wrong with the settings and the weights is told when they are read."""
        self._check_kinds()
        usual = {name: field.default for name, field in type(self).model_fields.items()}
        if odd := sorted(name for name in self.idle() if getattr(self, name) != usual[name]):
            raise Mistake(f"no {odd[0]}, which means nothing to such a network")
        self.check((info.context or {}).get("extent"))
        shapes = self.shapes()
        if shapes and self.parameter_bytes() > LARGEST:
            raise Mistake(f"weights of at most {LARGEST:,} bytes (these settings make {self.parameter_bytes():,})")
        if shapes is None:
            self._built()
        elif self.checkpoint != NONE:
            place = checkpoint.place_of(self.checkpoint)
            checkpoint.hold_weights(place, self._weights, checkpoint.forms(shapes))

    def _check_kinds(self) -> None:
        """Unless it says itself what it sees, its one kind of world must say so."""
        if type(self).encoding is not Policy.encoding:
            return
        if len(self.kinds) != 1:
            raise Mistake("a network of one kind of world, or one with an encoding of its own")
        if not self.kinds & {*registered(ENCODED), *ENCODINGS}:
            raise Mistake(f"a network of a kind of world that has an encoding (this one is of {', '.join(self.kinds)})")

    def _built(self) -> Any:
        """The network with its weights."""
        return resolve_name(f"{AGENT}:weighted")(self)

    def trained(self) -> dict[str, Any]:
        """The settings that a card of these weights has."""
        return self.model_dump(mode="json", exclude={"checkpoint", "seed", "device"})
