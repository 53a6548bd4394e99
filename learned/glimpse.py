"""What goes on in a network as it decides: nothing is computed for it unless somebody looks."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.agent import PolicyAgent
from fogbench.learned.dnc.dnc import DNCState
from fogbench.learned.networks.memory import GRUState, LSTMState
from fogbench.learned.networks.network import Network
from fogbench.worlds.types import Array, Observation


class Glimpse(NamedTuple):
    """One decision, from the inside."""

    image: Array
    """[n], all numbers of what the network plans on."""
    planned: Array | None
    """[planned], what its planning module makes of that, see `Network.plan`; None of a network that does not tell."""
    scores: Array
    """[A], of the outputs."""
    held: Mapping[str, Array]
    """What is remembered after the decision; see `held`."""
    action: Any
    outputs: tuple[str, ...]
    """What the outputs are called."""


def glimpse(agent: PolicyAgent, observation: Observation) -> Glimpse:
    """Let an agent decide as it always does, and look."""
    inputs = agent.perceive(observation)
    with torch.inference_mode():
        planned = agent.network.plan(inputs) if type(agent.network).plan is not Network.plan else None
    scores = agent.decide(inputs)
    plan = None if planned is None else _numbers(planned)
    parts = _numbers(inputs.image), plan, _numbers(scores)
    return Glimpse(*parts, held(agent.state), agent.action, agent.encoding.outputs)


def _numbers(tensor: Tensor) -> Array:
    return np.asarray(tensor.flatten().cpu().numpy())


def held(state: Any) -> dict[str, Array]:
    """What the state of one sample holds.

    Returns:
        `controller` [hidden], its output; of an LSTM also `cell` [hidden]; of a DNC `memory` [N * D], one row after the
        other, and how far each row was `written` and `read` [N], the mean of the heads. Nothing of what remembers
        nothing.
    """
    match state:
        case DNCState(hidden=hidden, access=access):
            written, read = (weights.mean(-2) for weights in (access.write_weights, access.read_weights))
            parts = {"controller": hidden, "memory": access.memory.mT, "written": written, "read": read}
        case LSTMState(hidden, cell):
            parts = {"controller": hidden, "cell": cell}
        case GRUState(hidden):
            parts = {"controller": hidden}
        case _:
            parts = {}
    return {name: part.flatten().cpu().numpy().copy() for name, part in parts.items()}
