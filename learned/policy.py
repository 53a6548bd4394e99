"""What all learned policies share: settings that find their weights, and the decisions of one episode.

A setting that a scenario does not give is as in the checkpoint's card; one that it does give must be as in the card,
unless no weight depends on it (`fogbench.learned.checkpoint.WEIGHTLESS`).
"""

from functools import lru_cache
from typing import Annotated, Any, ClassVar, Literal, Self, cast

import numpy as np
import torch
from pydantic import (
    Field,
    ModelWrapValidatorHandler,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)
from torch import Tensor

from fogbench.learned import checkpoint
from fogbench.learned.checkpoint import NONE
from fogbench.learned.encoding.grid import STILL, Frame, Inputs, encode, gather
from fogbench.learned.network import Network, settled, tensors
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.settings import Settings, whole
from fogbench.worlds.types import Cell, Move, Observation, Task

Size = Annotated[int, Field(ge=1, le=1024)]
"""Of a part of a network."""


class Policy(Settings):
    """A network as an agent."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    checkpoint: Annotated[str, Field(examples=[NONE, "macn-grid", "./mine.safetensors"])]
    """The name of a shipped checkpoint, a file that ends in `.safetensors`, or `none` for fresh weights."""
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0
    """Of fresh weights."""
    device: Literal["cpu", "cuda"] = "cpu"
    """Where the network runs."""
    reading: Literal["window", "map"] = "window"
    """What the network plans on: a window around the agent, or the whole map, which ties it to one size."""
    size: tuple[Size, Size] = (11, 11)
    """Rows and columns of that window or map."""
    stitched: bool = False
    """Whether it sees the map known so far; else, the current view alone."""

    _weights: str = ""
    """The digest of the checkpoint's weights as they were when these settings were read."""

    def network(self) -> Network:
        """A network with weights drawn anew."""
        raise NotImplementedError

    def start(self, task: Task, rng: np.random.Generator) -> "PolicyAgent":
        """A fresh agent; it needs no luck.

        Raises:
            Mistake: a network that was made for maps of one size meets another.
        """
        del rng
        return PolicyAgent(self, task)

    def frame(self, task: Task) -> Frame:
        """What the network's image shows of the world of a task.

        Raises:
            Mistake: a network that was made for maps of one size meets another.
        """
        if not self.fits(task.extent):
            raise Mistake(f"got a map of {_by(task.extent)}; expected {_by(self.size)}, the size")
        return Frame(self.size, self.reading == "window")

    def fits(self, extent: tuple[float, ...] | None) -> bool:
        """Whether it can play on maps of some extent; of maps that differ that is not known yet."""
        return self.reading == "window" or extent in (None, self.size)

    def idle(self) -> frozenset[str]:
        """The settings that mean nothing together with the others; to give one of them another value is a mistake."""
        return frozenset()

    def parameter_bytes(self) -> int:
        """The bytes of all weights."""
        return sum(parameter.nbytes for parameter in weighted(self).parameters())

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
        if device == "cuda" and not torch.cuda.is_available():
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
            card.compare(settings.trained(), block)
            settings._weights = card.sha256  # noqa: SLF001  its own
        usual = {name: field.default for name, field in cls.model_fields.items()}
        if odd := sorted(name for name in settings.idle() if getattr(settings, name) != usual[name]):
            raise Mistake(f"no {odd[0]}, which means nothing to such a network")
        extent: Any = (info.context or {}).get("extent")
        if not settings.fits(extent):
            raise Mistake(f"a network for maps of {_by(extent)} (this one is for {_by(settings.size)})")
        weighted(settings)  # whatever is wrong with the weights is told now
        return settings

    def trained(self) -> dict[str, Any]:
        """The settings that a card of these weights has."""
        return self.model_dump(mode="json", exclude={"checkpoint", "seed", "device"})


def _by(extent: tuple[float, ...]) -> str:
    return "x".join(map(str, extent))


def load(settings: Policy) -> Network:
    """A network of some settings, with its weights, on its device, that can be trained.

    Raises:
        Mistake: the checkpoint is broken or does not fit.
    """
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(settings.seed)
        network = settings.network().eval()
    if settings.checkpoint != NONE:
        place = checkpoint.place_of(settings.checkpoint)
        card = checkpoint.read_card(place)
        if card.sha256 != settings._weights:  # noqa: SLF001  whose words name them
            raise Mistake(f"a checkpoint that stays as it was ({place.name} was replaced meanwhile)")
        checkpoint.read_weights(place, card, network)
    return network.to(settings.device)


@lru_cache(maxsize=64)
def weighted(settings: Policy) -> Network:
    """The network of some settings as it decides; made once in a process.

    Raises:
        Mistake: the checkpoint is broken or does not fit.
    """
    return settled(load(settings))


class PolicyAgent:
    """One episode of a network, which takes the move of the highest score; of equals, the first."""

    def __init__(self, settings: Policy, task: Task) -> None:
        """Nothing is remembered yet."""
        self.network = weighted(settings)
        self.frame = settings.frame(task)
        self.device = settings.device
        self.goal: Cell = task.goal
        self.stitched = KnownMap(task.extent) if settings.stitched else None
        self.state = self.network.blank((1,))
        self.move = STILL

    def act(self, observation: Observation) -> Move:
        """One step of the network."""
        self.decide(self.perceive(observation))
        return Move(self.move)

    def perceive(self, observation: Observation) -> Inputs:
        """What the network sees of an observation."""
        maps = None
        if self.stitched:
            self.stitched.update(observation)
            maps = [self.stitched.cells]
        known = gather([observation], [self.goal], [self.move], maps)
        return encode(known, self.frame).to(self.device)

    @torch.inference_mode()
    def decide(self, inputs: Inputs) -> Tensor:
        """Take a step; returns the scores [1, 4] of the moves."""
        scores, self.state = self.network(inputs, self.state)
        self.move = int(scores.argmax())
        return cast(Tensor, scores)

    def memory_bytes(self) -> int:
        """The state of the network, and the known map where it sees one."""
        known = self.stitched.cells.nbytes if self.stitched else 0
        return known + sum(tensor.nbytes for tensor in tensors(self.state))

    def search_nodes(self) -> int:
        """There is no search."""
        return 0
