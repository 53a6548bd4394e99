"""Work of planners that tells how fast a machine is."""

import numpy as np

from fogbench.planners.astar import search

EMPTY = np.zeros((512, 512), np.uint8)


def search_empty_map() -> None:
    """Search from corner to corner of 512x512 unknown cells."""
    search(EMPTY, (0, 0), (511, 511))
