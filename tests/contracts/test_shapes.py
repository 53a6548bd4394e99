"""The contract of every learned policy: its settings alone say what weights its network has."""

import numpy as np

from fogbench.learned.graph_policy import GraphPolicy
from fogbench.learned.policy import Policy
from fogbench.worlds.robot.rules import Body, Lidar, Outfit
from fogbench.worlds.types import Budget, Task


def test_shapes_are_those_of_the_network(policy: Policy) -> None:
    """Names and shapes of all weights, and how many bytes they take."""
    weights = policy.network().state_dict()
    assert policy.shapes() in (None, {name: tuple(tensor.shape) for name, tensor in weights.items()})
    assert {tensor.element_size() for tensor in weights.values()} == {4}
    assert policy.parameter_bytes() == sum(tensor.nbytes for tensor in weights.values())


def test_what_plays_is_named(policy: Policy) -> None:
    """What no import statement names is told: the module of the agent, the network and the encoding."""
    (kind,) = policy.kinds
    extent = (policy.nodes,) if isinstance(policy, GraphPolicy) else getattr(policy, "size", (1, 1))
    sensor = Outfit(Lidar(), Body(), cell=0.1, goal_radius=0.3) if kind == "robot" else None
    task = Task(kind, (0, 0), sensor, Budget(1), extent)
    agent = type(policy.start(task, np.random.default_rng()))
    made = [type(each) for each in (policy.network(), policy.encoding())]
    assert policy.uses() == (agent.__module__, *(f"{each.__module__}:{each.__qualname__}" for each in made))
