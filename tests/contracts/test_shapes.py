"""The contract of every learned policy: its settings alone say what weights its network has."""

from fogbench.learned.policy import Policy


def test_shapes_are_those_of_the_network(policy: Policy) -> None:
    """Names and shapes of all weights, and how many bytes they take."""
    weights = policy.network().state_dict()
    assert policy.shapes() == {name: tuple(tensor.shape) for name, tensor in weights.items()}
    assert {tensor.element_size() for tensor in weights.values()} == {4}
    assert policy.parameter_bytes() == sum(tensor.nbytes for tensor in weights.values())


def test_what_plays_is_named(policy: Policy) -> None:
    """The modules that no import statement names are told: that of the network, and that of the agent."""
    assert type(policy.network()).__module__ in policy.uses()
    assert "fogbench.learned.agent" in policy.uses()
