"""Simple obstacles on one map: the same for all episodes, whose tasks differ."""

from functools import lru_cache

import numpy as np

from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.layout import CellConditions, Layout
from fogbench.worlds.settings import Seed


class FixedBlobs(Blobs):
    """Rectangles of random size at random places, drawn once: only start and goal differ from episode to episode."""

    map_seed: Seed = 0
    """Fixes the map, whatever the seed of the scenario."""

    def draw(self, rng: np.random.Generator, conditions: CellConditions) -> Layout:
        """The map, without a task; no luck of the episode is drawn."""
        del rng
        return _drawn(self, conditions)


@lru_cache(maxsize=4)
def _drawn(family: FixedBlobs, conditions: CellConditions) -> Layout:
    return Blobs.draw(family, np.random.default_rng(family.map_seed), conditions)
