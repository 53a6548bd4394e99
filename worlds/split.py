"""A length cut at random places."""

import numpy as np


def split(total: int, parts: int, least: int, rng: np.random.Generator) -> list[int]:
    """Cut `total` cells into `parts` of at least `least` each; the cuts fall uniformly on what is above the least.

    Raises:
        ValueError: `total` is less than `parts * least`.
    """
    spare = total - parts * least
    cuts = np.sort(rng.integers(spare + 1, size=parts - 1))  # [parts - 1]
    return [least + part for part in np.diff(cuts, prepend=0, append=spare).tolist()]
