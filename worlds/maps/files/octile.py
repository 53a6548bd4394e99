"""The Moving AI Lab's `.map` and `.scen` files (Sturtevant 2012, "Benchmarks for Grid-Based Pathfinding").

Every mistake in a file is a `MapError` that reads `FILE:LINE: got X; expected Y`.
"""

import math
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fogbench.worlds.types import Array, Cell, MapError

FREE_LETTERS, BLOCKED_LETTERS = ".GS", "@OTW"
"""The letters of a map. Swamp `S` is free as the format says; water `W` cannot be entered from land."""


WHOLE = re.compile("[0-9]{1,9}")
"""A whole number as the files write it."""


class Trip(NamedTuple):
    """One line of a `.scen` file."""

    start: Cell
    goal: Cell
    octile: float
    """The file's own optimal length: 8-connected, diagonals of length sqrt(2) that cut no corner [cells]."""


def read_map(path: Path, contents: bytes) -> Array:
    """The map of a `.map` file: [H, W] bool, True where blocked, read-only."""
    lines = contents.decode("ascii", "replace").rstrip().splitlines()
    _expect(path, lines, 1, "type octile")
    height, width = _dimension(path, lines, 2, "height"), _dimension(path, lines, 3, "width")
    _expect(path, lines, 4, "map")
    rows = lines[4:]
    for number, row in enumerate(rows, 5):
        _check_row(f"{path}:{number}", row, width)
    if len(rows) != height:
        raise MapError(f"{path}:{len(lines)}: got {len(rows)} rows; expected {height}, the height")
    letters = np.frombuffer("".join(rows).encode(), np.uint8).reshape(height, width)
    blocked: Array = np.isin(letters, np.frombuffer(BLOCKED_LETTERS.encode(), np.uint8))  # [H, W]
    blocked.setflags(write=False)
    return blocked


def read_scen(path: Path, contents: bytes, shape: tuple[int, ...]) -> tuple[Trip, ...]:
    """The tasks of a `.scen` file for a map of `shape` `(H, W)`; the file's x is a column, its y a row."""
    lines = contents.decode("utf-8", "replace").rstrip().splitlines()
    version = _line(lines, 1)
    if version.split()[:1] != ["version"]:
        raise MapError(f"{path}:1: got {version[:40]!r}; expected 'version 1'")
    return tuple(_trip(f"{path}:{number}", line, shape) for number, line in enumerate(lines[1:], 2))


def _trip(place: str, line: str, shape: tuple[int, ...]) -> Trip:
    fields = line.split("\t" if "\t" in line else None)
    if len(fields) != 9:
        raise MapError(f"{place}: got {len(fields)} fields; expected 9: bucket, map, width, height, x, y, x, y, length")
    width, height, *ends = (_whole(place, field) for field in fields[2:8])
    if (height, width) != shape:
        raise MapError(
            f"{place}: got a map of {width} x {height}; expected {shape[1]} x {shape[0]}, as the map file has"
        )
    for x, y in (ends[:2], ends[2:]):
        if x >= width or y >= height:
            raise MapError(f"{place}: got x {x}, y {y}; expected x below {width} and y below {height}")
    return Trip((ends[1], ends[0]), (ends[3], ends[2]), _length(place, fields[8]))


def _expect(path: Path, lines: list[str], number: int, text: str) -> None:
    line = _line(lines, number)
    if line.split() != text.split():
        raise MapError(f"{path}:{number}: got {line[:40]!r}; expected {text!r}")


def _dimension(path: Path, lines: list[str], number: int, name: str) -> int:
    line = _line(lines, number)
    word, _, value = line.strip().partition(" ")
    if word != name or not WHOLE.fullmatch(value.strip()) or int(value) == 0:
        raise MapError(f"{path}:{number}: got {line[:40]!r}; expected {name!r} and a whole number from 1")
    return int(value)


def _check_row(place: str, row: str, width: int) -> None:
    if len(row) != width:
        raise MapError(f"{place}: got {len(row)} letters; expected {width}, the width")
    strange = set(row) - set(FREE_LETTERS + BLOCKED_LETTERS)
    if strange:
        column = min(map(row.index, strange))
        expected = " ".join(FREE_LETTERS + BLOCKED_LETTERS)
        raise MapError(f"{place}: got {row[column]!r} in column {column}; expected one of {expected}")


def _whole(place: str, field: str) -> int:
    if not WHOLE.fullmatch(field.strip()):
        raise MapError(f"{place}: got {field[:40]!r}; expected a whole number from 0")
    return int(field)


def _length(place: str, field: str) -> float:
    try:
        length = float(field)
    except ValueError:
        length = math.nan
    if not 0 <= length < math.inf:
        raise MapError(f"{place}: got {field[:40]!r}; expected a length from 0")
    return length


def _line(lines: list[str], number: int) -> str:
    return lines[number - 1] if number <= len(lines) else ""
