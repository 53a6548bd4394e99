"""Networks with their weights, and the decisions of one episode."""

from functools import lru_cache
from typing import Any, cast

import torch
from torch import Tensor

from fogbench.learned import checkpoint
from fogbench.learned.checkpoint import NONE, form
from fogbench.learned.encoding.encoding import Viewpoint
from fogbench.learned.kernels.room import keep_freed
from fogbench.learned.networks.network import Network, settled, tensors
from fogbench.learned.policy import Policy
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Observation, Task


def load(settings: Policy) -> Network:
    """A network of some settings, with its weights, on its device, that can be trained.

    From now on this process keeps the memory of tensors that are gone, for those of the next step.

    Raises:
        Mistake: the checkpoint is broken or does not fit.
    """
    keep_freed()
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(settings.seed)
        network = cast(Network, settings.network().eval())
    if settings.checkpoint != NONE:
        place = checkpoint.place_of(settings.checkpoint)
        card = checkpoint.read_card(place)
        if card.sha256 != settings._weights:  # noqa: SLF001  whose words name them
            raise Mistake(f"a checkpoint that stays as it was ({place.name} was replaced meanwhile)")
        forms = {name: form(tensor) for name, tensor in network.state_dict().items()}
        weights = checkpoint.read_weights(place, card.sha256, forms)
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
    """One episode of a network, which takes the output of the highest score; of equals, the first."""

    action: Any = None
    """What was decided last."""

    def __init__(self, settings: Policy, task: Task) -> None:
        """Nothing is remembered yet.

        Raises:
            Mistake: the network is not for such a task.
        """
        self.network = weighted(settings)
        self.encoding = settings.encoding()
        self.viewpoint: Viewpoint = self.encoding.start(task)
        self.device = settings.device
        self.state = self.network.blank((1,))

    def act(self, observation: Observation) -> Any:
        """One step of the network."""
        self.decide(self.perceive(observation))
        return self.action

    def perceive(self, observation: Observation) -> Any:
        """What the network sees after an observation."""
        self.viewpoint.see(observation)
        return self.encoding.encode([self.viewpoint]).to(self.device)

    @torch.inference_mode()
    def decide(self, inputs: Any) -> Tensor:
        """Take a step; returns the scores [1, A] of the outputs."""
        scores, self.state = self.network(inputs, self.state)
        self.action = self.viewpoint.act(int(self.weighed(scores, inputs).argmax()))
        return cast(Tensor, scores)

    def weighed(self, scores: Tensor, inputs: Any) -> Tensor:
        """The scores [1, A] by which it decides: the network's."""
        del inputs
        return scores

    def memory_bytes(self) -> int:
        """The state of the network, and what its viewpoint carries."""
        return self.viewpoint.bytes + sum(tensor.nbytes for tensor in tensors(self.state))

    def search_nodes(self) -> int:
        """There is no search."""
        return 0


class MaskedAgent(PolicyAgent):
    """One that takes no output that is seen to lead into an obstacle."""

    def weighed(self, scores: Tensor, inputs: Any) -> Tensor:
        """Those of outputs that are not open are -inf."""
        is_open = torch.from_numpy(self.encoding.open(inputs)).to(scores.device)
        return scores.masked_fill(~is_open, -torch.inf)
