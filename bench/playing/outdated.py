"""Rows that do not count any more are kept apart until they do again. A run sorts them before it plays.

What cannot play here, since a package is missing, stays where it is: nobody can tell whether it counts.
"""

from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pyarrow.parquet as pq

from fogbench.bench.playing.store import CURRENT, KEYS, OUTDATED, WHO, current, load, new_part, parts, write_table
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.types import Array

TOLD = list(dict.fromkeys([*WHO, *KEYS]))
"""The columns that say where a row belongs."""


def sort_rows(folder: Path, scenario: Scenario) -> None:
    """Move the rows of a store that do not count to `outdated/`, and take back those that count again.

    A kill in between leaves a row in both folders, never in none.

    Args:
        folder: of the store, which this process holds.
        scenario: as it is now.

    Raises:
        StoreError: a file is broken, or cannot be written.
    """
    valid, unknown = current(scenario)[KEYS], _skipped(scenario)
    _move(folder, CURRENT, OUTDATED, lambda rows: ~(_among(rows, valid) | _among(rows, unknown)))
    _move(folder, OUTDATED, CURRENT, lambda rows: _among(rows, valid))


def _skipped(scenario: Scenario) -> pd.DataFrame:
    """The variants and agents that a package is missing for."""
    agents = [(variant.name, entry.label) for variant in scenario.variants for entry in variant.agents if entry.skipped]
    return pd.DataFrame(agents, columns=KEYS[:2])


def _move(folder: Path, source: str, target: str, goes: Callable[[pd.DataFrame], Array]) -> None:
    there = pd.concat([pd.DataFrame(columns=TOLD), *map(_told, parts(folder, target))])
    for part in parts(folder, source):
        told = _told(part)
        moved = goes(told)  # [n] bool
        if moved.any():
            rows, new = pq.read_table(part), moved & ~_among(told, there)
            if new.any():  # not those of a run that was killed here
                write_table(new_part(folder, target), rows.filter(new))
            if moved.all():
                part.unlink()
            else:
                write_table(part, rows.filter(~moved))


def _told(part: Path) -> pd.DataFrame:
    told: pd.DataFrame = load(part, TOLD).to_pandas()
    return told


def _among(rows: pd.DataFrame, listed: pd.DataFrame) -> Array:
    """Which rows agree with a listed one on all its columns: [n] bool."""
    names = list(listed.columns)
    return pd.MultiIndex.from_frame(rows[names]).isin(pd.MultiIndex.from_frame(listed))
