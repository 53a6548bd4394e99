"""The shapes of a VI module's weights. Importing this imports no torch."""

from fogbench.learned.shapes import Shapes, convolution, joined

ACTIONS = 4
"""Channels of Q: a value's kernels lead to the four neighbours of a cell, whatever the network's outputs mean."""


HIDDEN = 150
"""Channels between the two convolutions of a reward map."""


def reward_shapes(channels: int, hidden: int = HIDDEN, rewards: int = ACTIONS) -> Shapes:
    """Those of a reward map: 3x3 from the image's channels to `hidden` ones, then 1x1."""
    return joined(features=convolution(channels, hidden), mix=convolution(hidden, rewards, 1))


def planner_shapes(channels: int) -> Shapes:
    """Those of a VI module on images of some channels."""
    return {**joined(reward_map=reward_shapes(channels)), "kernels": (ACTIONS, ACTIONS + 1, 3, 3)}
