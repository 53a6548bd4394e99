"""All that is wrong with a map file, told in one go."""

from collections.abc import Sequence
from pathlib import Path

from fogbench.worlds.reading.positions import Fault, told
from fogbench.worlds.types import MapError

MOST = 20
"""Mistakes of a file that are told; of more, the number is."""


def refuse(path: Path, faults: Sequence[Fault]) -> None:
    """Go on with a file that has no faults.

    Raises:
        MapError: it has some; one line for each, `FILE:LINE:COLUMN  got X; expected Y.`
    """
    if not faults:
        return
    lines = told(faults, str(path))
    rest = len(lines) - MOST
    more = [f"{path}: {rest} more mistakes."] if rest > 0 else []
    raise MapError("\n".join([*lines[:MOST], *more]))
