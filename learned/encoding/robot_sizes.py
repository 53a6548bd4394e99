"""How much a network sees of the world around a robot. Importing this imports no torch."""

WINDOW = 10
"""Cells of the image to each side: the paper's 10x10."""

CELL = 0.5
"""Side of a cell of the image [m]."""

CHANNELS = 3
"""Of the image: free, blocked, goal; a cell that is neither free nor blocked is unknown."""

SECTORS = 72
"""All around the robot, of each the nearest reading."""

BEAMS = 2 * SECTORS
"""Numbers of the sectors: how near a wall is, within a metre, and how far, within the window."""

BEARINGS = 24
"""Directions that the goal's is told by."""

COMPASS = BEARINGS + 18
"""Numbers of a compass; see `robot_inputs`."""

SEEN = CHANNELS * WINDOW**2 + BEAMS + COMPASS
"""Numbers that a memory is told as they are."""

CHOICES = 128
"""Outputs: the choices of `fogbench.planners.robot.choices`, which loads Numba."""
