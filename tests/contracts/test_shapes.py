"""The contract of every learned policy: its settings alone say what weights its network has."""

import numpy as np

from fogbench.learned.policy import Policy
from fogbench.worlds.types import Budget, Task


def test_shapes_are_those_of_the_network(policy: Policy) -> None:
    """Names and shapes of all weights, and how many bytes they take."""
    weights = policy.network().state_dict()
    assert policy.shapes() == {name: tuple(tensor.shape) for name, tensor in weights.items()}
    assert {tensor.element_size() for tensor in weights.values()} == {4}
    assert policy.parameter_bytes() == sum(tensor.nbytes for tensor in weights.values())


def test_what_plays_is_named(policy: Policy) -> None:
    """The modules that no import statement names are told: of the agent, the network and the encoding."""
    task = Task("grid", (0, 0), None, Budget(1), getattr(policy, "size", (1, 1)))
    plays = [policy.start(task, np.random.default_rng()), policy.network(), policy.encoding()]
    assert policy.uses() == tuple(type(each).__module__ for each in plays)
