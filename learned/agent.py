"""Networks with their weights, and the decisions of one episode."""

from functools import lru_cache
from typing import cast

import torch
from torch import Tensor

from fogbench.learned import checkpoint
from fogbench.learned.checkpoint import NONE, form
from fogbench.learned.encoding.grid import STILL, Inputs, encode, gather
from fogbench.learned.grid_policy import GridPolicy
from fogbench.learned.networks.network import Network, settled, tensors
from fogbench.learned.policy import Policy
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Cell, Move, Observation, Task


def load(settings: Policy) -> Network:
    """A network of some settings, with its weights, on its device, that can be trained.

    Raises:
        Mistake: the checkpoint is broken or does not fit.
    """
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(settings.seed)
        network = cast(Network, settings.network().eval())
    if settings.checkpoint != NONE:
        place = checkpoint.place_of(settings.checkpoint)
        card = checkpoint.read_card(place)
        if card.sha256 != settings._weights:  # noqa: SLF001  whose words name them
            raise Mistake(f"a checkpoint that stays as it was ({place.name} was replaced meanwhile)")
        forms = {name: form(tensor) for name, tensor in network.state_dict().items()}
        weights = checkpoint.read_weights(place, card, forms)
        network.load_state_dict({name: torch.from_numpy(array) for name, array in weights.items()})
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

    def __init__(self, settings: GridPolicy, task: Task) -> None:
        """Nothing is remembered yet."""
        self.network = weighted(settings)
        self.frame = settings.shown(task)
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
