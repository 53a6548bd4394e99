"""Rows that do not count any more are kept apart until they do again. A run sorts them before it plays.

What cannot play here, since a package is missing, stays where it is: nobody can tell whether it counts.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq

from fogbench.bench.playing.store import (
    CURRENT,
    KEYS,
    OUTDATED,
    WHO,
    current,
    load,
    new_part,
    parts,
    together,
    write_table,
)
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.types import Array

Line = tuple[Any, ...]

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
    valid, unknown = set(_lines(current(scenario), KEYS)), _skipped(scenario)
    _move(folder, CURRENT, OUTDATED, lambda rows: ~(_among(rows, KEYS, valid) | _among(rows, KEYS[:2], unknown)))
    _move(folder, OUTDATED, CURRENT, lambda rows: _among(rows, KEYS, valid))


def _skipped(scenario: Scenario) -> set[Line]:
    """The variants and agents that a package is missing for."""
    return {(variant.name, entry.label) for variant in scenario.variants for entry in variant.agents if entry.skipped}


def _move(folder: Path, source: str, target: str, goes: Callable[[pd.DataFrame], Array]) -> None:
    files = parts(folder, source)
    tables = [load(part, TOLD) for part in files]
    told = together(tables, TOLD).to_pandas()
    moved = goes(told)  # [n] bool
    if not moved.any():  # mostly
        return
    others = together((load(part, TOLD) for part in parts(folder, target)), TOLD)
    there = set(_lines(others.to_pandas(), TOLD))
    new = moved & ~_among(told, TOLD, there)  # not those of a run that was killed here
    ends = np.cumsum([len(table) for table in tables])[:-1]
    for part, going, coming in zip(files, np.split(moved, ends), np.split(new, ends), strict=True):
        if going.any():
            rows = pq.read_table(part)
            if coming.any():
                write_table(new_part(folder, target), rows.filter(coming))
            if going.all():
                part.unlink()
            else:
                write_table(part, rows.filter(~going))


def _lines(rows: pd.DataFrame, names: list[str]) -> Iterator[Line]:
    """What each row has in some columns."""
    return zip(*(rows[name] for name in names), strict=True)


def _among(rows: pd.DataFrame, names: list[str], listed: set[Line]) -> Array:
    """Which rows have something listed in some columns: [n] bool."""
    return np.array([line in listed for line in _lines(rows, names)], np.bool_)
