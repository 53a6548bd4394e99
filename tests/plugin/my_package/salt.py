"""A map family of another package."""

import numpy as np

from fogbench import CellConditions, Layout, Probability, SquareMaps


class Salt(SquareMaps):
    """Single blocked cells, strewn evenly."""

    share: Probability

    def draw(self, rng: np.random.Generator, conditions: CellConditions) -> Layout:
        """A map."""
        del conditions
        return Layout(rng.random((self.size, self.size)) < self.share)  # [H, W]
