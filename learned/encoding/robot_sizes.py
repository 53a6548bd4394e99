"""How much a network sees of the world around a robot. Importing this imports no torch."""

CHANNELS = 3
"""Of the image: free, blocked, goal; a cell that is neither free nor blocked is unknown."""

SECTORS = 72
"""All around the robot, of each the nearest reading."""

RINGS = (0.25, 0.5, 1.0, 2.0)
"""Metres from the body, within each of which it is told how near a wall is."""

FAR = 5.0
"""Metres beyond which walls and goals are far."""

BEAMS = (len(RINGS) + 1) * SECTORS
"""Numbers of the sectors: how near a wall is in each ring, and how far."""

BEARINGS = 24
"""Directions that the goal's is told by."""

WAVES = 3
"""Wavelengths that a place on the map is told by: twice its side, once, half."""

COMPASS = BEARINGS + 14 + 8 * WAVES
"""Numbers of a compass; see `robot_inputs`."""

CHOICES = 128
"""Outputs: the choices of `fogbench.planners.robot.choices`, which loads Numba."""


def seen_count(window: int) -> int:
    """Numbers of an image of so many cells to each side, of the sectors and of a compass."""
    return CHANNELS * window**2 + BEAMS + COMPASS
