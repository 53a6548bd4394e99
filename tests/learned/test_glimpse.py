"""What goes on in a network: what is shown of it, and that looking changes nothing."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import torch

from fogbench.learned.cnn_memory import CnnMemory
from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.dnc import DNCState
from fogbench.learned.glimpse import glimpse, held
from fogbench.learned.macn import Macn
from fogbench.learned.networks.memory import LSTMState
from fogbench.learned.policy import Policy
from fogbench.learned.vin import Vin

HELD = {
    "dnc": {"controller": (256,), "memory": (32 * 8,), "written": (32,), "read": (32,)},
    "lstm": {"controller": (256,), "cell": (256,)},
    "gru": {"controller": (256,)},
    "feedforward": {},
}
"""Shapes of what the memories hold with the paper's sizes."""


@pytest.mark.parametrize(
    "policy",
    [
        *(Macn(checkpoint="none", memory=memory) for memory in HELD),
        CnnMemory(checkpoint="none"),
        Vin(checkpoint="none", stitched=True),
    ],
    ids=repr,
)
def test_looking_changes_no_decision(policy: Policy, draw: Callable[..., Any]) -> None:
    """Watched or not, an agent takes the same moves and remembers the same; the best score is the move."""
    world, rng = draw("S..#. ..#.. ....G", collision="blocked"), np.random.default_rng(0)
    watched, alone = policy.start(world.task, rng), policy.start(world.task, rng)
    state = world.reset()
    for _ in range(6):
        observation = world.sense(state, rng)
        inputs = alone.perceive(observation)
        seen, move = glimpse(watched, observation), alone.act(observation)
        assert (seen.action, seen.scores.argmax(), seen.scores.shape) == (move, move, (4,))
        assert seen.outputs == ("down", "right", "up", "left")
        assert np.array_equal(seen.image, inputs.image.flatten())
        assert np.array_equal(seen.planned, alone.network.plan(inputs).flatten())
        for name, numbers in held(alone.state).items():
            assert np.array_equal(seen.held[name], numbers)
        shapes = {name: numbers.shape for name, numbers in seen.held.items()}
        assert shapes == (HELD[getattr(policy, "memory", "feedforward")])
        state = world.step(state, move, rng).state


def test_what_a_hand_made_state_holds() -> None:
    """Of a DNC the memory row by row and the means of its heads; of an LSTM its cell; of nothing, nothing."""
    output = torch.tensor([[9.0, -9]])
    memory = torch.tensor([[[1.0, 2, 3], [4, 5, 6]]])  # [1, D, N]
    read = torch.tensor([[[0.5, 0.5, 0], [0.25, 0, 0.75]]])  # [1, R, N]
    none = torch.zeros(1, 3)
    access = AccessState(memory, read, torch.tensor([[[0, 1.0, 0]]]), none, none, none)
    parts = held(DNCState(output, none, none, access))
    assert {name: numbers.tolist() for name, numbers in parts.items()} == {
        "controller": [9, -9],
        "memory": [1, 4, 2, 5, 3, 6],
        "written": [0, 1, 0],
        "read": [0.375, 0.25, 0.375],
    }
    parts = held(LSTMState(output, torch.tensor([[7.0, 8]])))
    assert {name: numbers.tolist() for name, numbers in parts.items()} == {"controller": [9, -9], "cell": [7, 8]}
    assert held(()) == {}
