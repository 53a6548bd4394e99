"""The five networks, against what the papers say they are."""

from collections.abc import Callable
from copy import deepcopy
from typing import Any

import numpy as np
import pytest
import torch
from torch import Tensor, nn

from fogbench.learned.cnn_memory import CnnMemory
from fogbench.learned.dnc.dnc import DNC
from fogbench.learned.encoding.grid_inputs import Inputs
from fogbench.learned.encoding.grid_sizes import CHANNELS, COMPASS, SIGHT
from fogbench.learned.macn import Macn
from fogbench.learned.networks.memory import GRU, LSTM, FeedForward, remember
from fogbench.learned.networks.network import settled
from fogbench.learned.policy import Policy
from fogbench.learned.value_iteration.value_iteration import ValueIteration, plain
from fogbench.learned.vin import Vin

NETWORKS: dict[str, Policy] = {
    "macn": Macn(checkpoint="none"),
    "macn with few links": Macn(checkpoint="none", links=3, channels=8),
    "macn lstm": Macn(checkpoint="none", memory="lstm", channels=20),
    "macn gru": Macn(checkpoint="none", memory="gru"),
    "macn feed-forward": Macn(checkpoint="none", memory="feedforward"),
    "macn without convolutions": Macn(checkpoint="none", channels=None),
    "macn without a layer of features": Macn(checkpoint="none", features=None),
    "macn on the map": Macn(checkpoint="none", reading="map", size=(6, 9), iterations=5, channels=5),
    "vin": Vin(checkpoint="none", size=(6, 9)),
    "cnn + memory": CnnMemory(checkpoint="none", size=(7, 7), reads=1, writes=2, links=False),
}


def seen(policy: Policy, batch: int, seed: int = 0) -> Inputs:
    """Something to see."""
    rng = np.random.default_rng(seed)
    (rows, columns), side = policy.size, 2 * SIGHT + 1
    image, sight = (rng.random((batch, CHANNELS, *shape)) < 0.3 for shape in (policy.size, (side, side)))
    cells = rng.integers(0, rows * columns, batch)
    compass = rng.normal(size=(batch, COMPASS))
    floats = [torch.from_numpy(part.astype(np.float32)) for part in (image, sight, compass)]
    return Inputs(floats[0], torch.from_numpy(cells), floats[1], floats[2])


def run(network: Any, steps: list[Inputs]) -> Tensor:
    """The scores [T, B, 4] of some steps."""
    state, scores = network.blank((len(steps[0].image),)), []
    for inputs in steps:
        score, state = network(inputs, state)
        scores.append(score)
    return torch.stack(scores)


@pytest.mark.parametrize("name", NETWORKS)
@torch.no_grad()
def test_a_batch_is_its_samples(name: str) -> None:
    """Over several steps, each sample of a batch gets the scores that it gets alone."""
    policy = NETWORKS[name]
    torch.manual_seed(0)
    network = policy.network()
    steps = [seen(policy, 3, step) for step in range(4)]
    together = run(network, steps)
    assert together.shape == (4, 3, 4)
    for b in range(3):
        alone = run(network, [Inputs(*(part[b : b + 1] for part in inputs)) for inputs in steps])
        assert torch.allclose(alone[:, 0], together[:, b], atol=1e-5)


@pytest.mark.parametrize("name", NETWORKS)
def test_a_settled_network_is_the_same(name: str) -> None:
    """What runs in one call once the weights no longer change gives the same scores, for one sample and for more."""
    policy = NETWORKS[name]
    torch.manual_seed(0)
    network = policy.network().double()
    for batch in (1, 3):
        steps = [double(seen(policy, batch, step)) for step in range(4)]
        expected = run(network, steps)
        found = run(settled(deepcopy(network)), steps)
        torch.testing.assert_close(found, expected.detach(), rtol=1e-10, atol=1e-12)


def double(inputs: Inputs) -> Inputs:
    """The same in double precision."""
    return Inputs(*(part.double() if part.is_floating_point() else part for part in inputs))


@pytest.mark.parametrize("name", NETWORKS)
@torch.no_grad()
def test_who_remembers(name: str) -> None:
    """What was seen before changes the scores of those that have a memory, and of no other."""
    policy = NETWORKS[name]
    torch.manual_seed(0)
    network, now = policy.network(), seen(policy, 2, 9)
    here, there = (run(network, [seen(policy, 2, seed), now])[1] for seed in (1, 2))
    remembers = getattr(policy, "memory", "none") in {"dnc", "lstm", "gru"}
    assert (not torch.equal(here, there)) == remembers


@pytest.mark.parametrize("name", NETWORKS)
def test_all_weights_learn(name: str) -> None:
    """Every parameter gets a gradient that is not zero."""
    policy = NETWORKS[name]
    torch.manual_seed(0)
    network = policy.network()
    run(network, [seen(policy, 4, step) for step in range(4)]).square().sum().backward()
    for parameter, tensor in network.named_parameters():
        assert tensor.grad is not None, parameter
        assert tensor.grad.abs().sum() > 0, parameter


def test_macn_sees_values_relative_to_its_cell() -> None:
    """Values and moves' values less the value at the agent's cell; whoever adds a constant to all tells it nothing."""
    policy = NETWORKS["macn on the map"]
    torch.manual_seed(0)
    network, inputs = policy.network(), seen(policy, 3)
    told = network.plan(inputs)
    q, v = plain(network.planner.reward_map(inputs.image), network.planner.normalised(), 5)
    for b, cell in enumerate(inputs.cells.tolist()):
        row, column = divmod(cell, 9)
        expected = torch.cat([v[b].flatten(), q[b, :, row, column]]) - v[b, row, column]
        assert torch.allclose(told[b], expected, atol=1e-5)
        assert told[b, cell] == 0
        assert told[b, -4:].max() == 0


def test_vin_acts_on_q_at_its_cell() -> None:
    """The scores are a linear map of Q at the agent's cell, and of nothing else."""
    policy = NETWORKS["vin"]
    torch.manual_seed(0)
    network, inputs = policy.network(), seen(policy, 3)
    q, _ = plain(network.planner.reward_map(inputs.image), network.planner.normalised(), 16)
    scores, _ = network(inputs, ())
    for b, cell in enumerate(inputs.cells.tolist()):
        row, column = divmod(cell, 9)
        assert torch.allclose(scores[b], network.output.weight @ q[b, :, row, column], atol=1e-5)
    blind = inputs._replace(sight=torch.zeros_like(inputs.sight), compass=torch.zeros_like(inputs.compass))
    assert torch.equal(network(blind, ())[0], scores)


def test_cnn_memory_has_four_convolutions_for_the_vi_module() -> None:
    """Four convolutions, no value iteration, and else the parts of a MACN."""
    cnn, macn = CnnMemory(checkpoint="none").network(), Macn(checkpoint="none").network()
    assert sum(isinstance(part, nn.Conv2d) for part in cnn.modules()) == 4
    assert not any(isinstance(part, ValueIteration) for part in cnn.modules())
    assert [name for name, _ in cnn.memory.named_parameters()] == [name for name, _ in macn.memory.named_parameters()]


@pytest.mark.parametrize(("memory", "part"), [("dnc", DNC), ("lstm", LSTM), ("gru", GRU), ("feedforward", FeedForward)])
def test_memories_go_by_name(memory: str, part: Callable[..., Any]) -> None:
    """Each memory is what its name says, with the sizes of the settings."""
    made = remember(Macn.model_validate({"checkpoint": "none", "memory": memory, "hidden": 20}), 10)
    assert type(made) is part
    assert made.step(torch.zeros(2, 10), made.blank((2,)))[0].shape == (2, 4)


def test_a_gru_by_its_equations() -> None:
    """Reset, update and candidate as PyTorch documents them, and the scores a linear map of the output."""
    torch.manual_seed(0)
    memory = GRU(5, 4, 7)
    cell, state = memory.controller, memory.blank((2,))
    for x in torch.randn(6, 2, 5):
        of_x = (x @ cell.weight_ih.T + cell.bias_ih).chunk(3, 1)
        of_h = (state.hidden @ cell.weight_hh.T + cell.bias_hh).chunk(3, 1)
        reset, update = (of_x[k] + of_h[k] for k in range(2))
        candidate = (of_x[2] + reset.sigmoid() * of_h[2]).tanh()
        hidden = (1 - update.sigmoid()) * candidate + update.sigmoid() * state.hidden
        scores, state = memory.step(x, state)
        assert torch.allclose(state.hidden, hidden, atol=1e-6)
        assert torch.allclose(scores, memory.output(hidden), atol=1e-6)


def test_an_lstm_by_hand() -> None:
    """The state of an LSTM is PyTorch's over the sequence, and the scores a linear map of its output."""
    torch.manual_seed(0)
    memory, reference = LSTM(5, 4, 7), nn.LSTM(5, 7)
    weights = memory.controller.weight.split([5, 7], dim=1), (memory.controller.bias, torch.zeros(4 * 7))
    for name, pair in zip(("weight", "bias"), weights, strict=True):
        for side, tensor in zip(("ih", "hh"), pair, strict=True):
            reference.get_parameter(f"{name}_{side}_l0").data = tensor.data
    sequence = torch.randn(6, 2, 5)
    state, scores = memory.blank((2,)), []
    for x in sequence:
        score, state = memory.step(x, state)
        scores.append(score)
    outputs, _ = reference(sequence)
    assert torch.allclose(torch.stack(scores), memory.output(outputs), atol=1e-6)
