"""A length cut at random places."""

import numpy as np


def split(total: int, parts: int, least: int, rng: np.random.Generator) -> list[int]:
    """Cut `total` cells, no fewer than `parts * least`, into `parts` of at least `least` each.

    The places of the cuts are independent and uniform over what is above the least.
    """
    spare = total - parts * least
    cuts = np.sort(rng.integers(spare + 1, size=parts - 1))  # [parts - 1]
    return [least + part for part in np.diff(cuts, prepend=0, append=spare).tolist()]
