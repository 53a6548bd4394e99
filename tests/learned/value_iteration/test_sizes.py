"""The sizes of value iteration's weights are known before they are drawn."""

from fogbench.learned.value_iteration.sizes import reward_map_shapes, shapes
from fogbench.learned.value_iteration.value_iteration import RewardMap, ValueIteration


def test_weights_have_the_shapes_that_were_said() -> None:
    """Names, order and shapes are those of a module's state."""
    module = ValueIteration(2, 5).state_dict()
    assert list(shapes(2).items()) == [(name, tuple(weight.shape)) for name, weight in module.items()]
    reward_map = RewardMap(3, 7, 2).state_dict()
    assert list(reward_map_shapes(3, 7, 2).items()) == [
        (name, tuple(weight.shape)) for name, weight in reward_map.items()
    ]
