"""The sizes of value iteration's weights, which need no PyTorch."""

from fogbench.learned.shapes import Shapes, convolution, parts

ACTIONS = 4
"""A."""
HIDDEN = 150
"""Channels between the two convolutions of a reward map."""
SIDE = 3
"""Of the kernels that see neighbours."""


def reward_map_shapes(channels: int, hidden: int = HIDDEN, rewards: int = ACTIONS) -> Shapes:
    """The weights of a `RewardMap` with these arguments."""
    return parts(features=convolution(channels, hidden, SIDE), mix=convolution(hidden, rewards, 1))


def shapes(channels: int) -> Shapes:
    """The weights of a `ValueIteration` of images with so many channels."""
    return {"kernels": (ACTIONS, ACTIONS + 1, SIDE, SIDE), **parts(reward_map=reward_map_shapes(channels))}
