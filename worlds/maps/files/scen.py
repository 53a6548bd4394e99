"""The Moving AI Lab's `.scen` files: lists of tasks on a map.

A line has nine fields: bucket, map, width, height, x and y of the start, x and y of the goal, and a length. All
mistakes of a file are told in one `MapError`.
"""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from fogbench.worlds.maps.files.mistakes import refuse
from fogbench.worlds.maps.files.text import WHOLE, lines_of, quoted
from fogbench.worlds.reading.positions import Fault
from fogbench.worlds.types import Cell

FIELDS = "9: bucket, map, width, height, x, y, x, y, length"


class Trip(NamedTuple):
    """One line of a `.scen` file."""

    line: int
    """Its number in the file, from 1."""
    map: str
    """The map that it names."""
    start: Cell
    goal: Cell
    octile: float
    """The file's own optimal length: 8-connected, diagonals of length sqrt(2) that cut no corner [cells]."""


def read_scen(path: Path, contents: bytes, shape: tuple[int, ...] | None) -> tuple[Trip, ...]:
    """The tasks of a `.scen` file; the file's x is a column, its y a row.

    Args:
        path: of the file.
        contents: of the file.
        shape: `(H, W)` of the map; None: of a broken one.

    Raises:
        MapError: the file is broken; a line for each mistake.
    """
    lines, faults = lines_of(contents), list[Fault]()
    if lines[0].split()[:1] != ["version"]:
        faults.append(Fault(1, 1, "", quoted(lines[0]), "'version 1'"))
    trips = [_trip(number, line, shape, faults) for number, line in enumerate(lines[1:], 2)]
    refuse(path, faults)
    return tuple(trip for trip in trips if trip)


def _trip(number: int, line: str, shape: tuple[int, ...] | None, faults: list[Fault]) -> Trip | None:
    fields = [field.strip() for field in line.split("\t" if "\t" in line else None)]
    if len(fields) != 9:
        faults.append(Fault(number, 1, "", f"{len(fields)} fields", FIELDS))
        return None
    wrong = [*_odd_numbers(fields, shape), *_odd_length(fields[8])]
    faults += [Fault(number, _column(line, fields, place), "", got, expected) for place, got, expected in wrong]
    if wrong:
        return None
    x, y, to_x, to_y = map(int, fields[4:8])
    return Trip(number, fields[1], (y, x), (to_y, to_x), float(fields[8]))


def _odd_numbers(fields: Sequence[str], shape: tuple[int, ...] | None) -> list[tuple[int, str, str]]:
    """What is wrong with sizes and coordinates: the field, what was got, what was expected."""
    wrong = [
        (place, quoted(fields[place]), "a whole number from 0")
        for place in range(2, 8)
        if not WHOLE.fullmatch(fields[place])
    ]
    if wrong:
        return wrong
    width, height = int(fields[2]), int(fields[3])
    if shape and (height, width) != shape:
        return [(2, f"a map of {width} x {height}", f"{shape[1]} x {shape[0]}, as the map file has")]
    limits = {4: ("x", width), 5: ("y", height), 6: ("x", width), 7: ("y", height)}
    return [
        (place, f"{axis} {fields[place]}", f"{axis} below {limit}")
        for place, (axis, limit) in limits.items()
        if int(fields[place]) >= limit
    ]


def _odd_length(field: str) -> list[tuple[int, str, str]]:
    try:
        length = float(field)
    except ValueError:
        length = math.nan
    return [] if 0 <= length < math.inf else [(8, quoted(field), "a length from 0")]


def _column(line: str, fields: Sequence[str], place: int) -> int:
    """Where a field begins, from 1."""
    end = 0
    for field in fields[:place]:
        end = line.index(field, end) + len(field)
    return line.index(fields[place], end) + 1
