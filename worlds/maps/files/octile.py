"""The Moving AI Lab's `.map` files (Sturtevant 2012, "Benchmarks for Grid-Based Pathfinding").

A file has any line ends, and may begin with a byte-order mark. All its mistakes are told in one `MapError`.
"""

import re
from collections.abc import Sequence
from itertools import takewhile
from pathlib import Path

import numpy as np

from fogbench.worlds.maps.files.mistakes import refuse
from fogbench.worlds.maps.files.text import WHOLE, lines_of, quoted
from fogbench.worlds.reading.positions import Fault
from fogbench.worlds.types import Array

FREE_LETTERS, BLOCKED_LETTERS = ".GS", "@OTW"
"""The letters of a map. Swamp `S` is free as the format says; water `W` cannot be entered from land."""

LETTERS = f"one of {' '.join(FREE_LETTERS + BLOCKED_LETTERS)}"

STRANGE = re.compile(f"[^{re.escape(FREE_LETTERS + BLOCKED_LETTERS)}]")
"""A letter that no map has."""

HEADER = ("type", "height", "width")
"""The lines before `map`, in their usual order."""

SIZE = "a whole number from 1"

MOST_CELLS = 2**26
"""Cells of the largest map that is read; a search needs nine bytes for each."""


def read_map(path: Path, contents: bytes) -> Array:
    """The map of a `.map` file: [H, W] bool, True where blocked, read-only.

    Raises:
        MapError: the file is broken; a line for each mistake.
    """
    lines, faults = lines_of(contents), list[Fault]()
    head = list(takewhile(lambda line: line.strip() != "map", lines))
    words = _header(head, faults)
    if len(head) == len(lines):
        faults.append(Fault(len(lines) + 1, 1, "", "no line 'map'", "it between the sizes and the rows"))
        refuse(path, faults)
    faults += [Fault(len(head) + 1, 1, word, "", "it above 'map'") for word in HEADER if word not in words]
    rows, height, width = lines[len(head) + 1 :], words.get("height", 0), words.get("width", 0)
    faults += _odd_letters(rows, len(head) + 2)
    if height and width:
        faults += _odd_sizes(rows, height, width, len(head) + 2)
    refuse(path, faults)
    letters = np.frombuffer("".join(rows).encode(), np.uint8).reshape(len(rows), -1)
    blocked: Array = np.isin(letters, np.frombuffer(BLOCKED_LETTERS.encode(), np.uint8))  # [H, W]
    blocked.setflags(write=False)
    return blocked


def _header(lines: Sequence[str], faults: list[Fault]) -> dict[str, int]:
    """The words of the lines before `map`, each with its number; 0 where it has none, or a wrong one."""
    words = dict[str, int]()
    for number, line in enumerate(lines[: len(HEADER) + 1], 1):
        word, value = (part.strip() for part in [*line.split(None, 1), "", ""][:2])
        if word not in HEADER or word in words:
            left = [repr(each) for each in HEADER if each not in words]
            faults.append(Fault(number, 1, "", quoted(line), " or ".join([*left, "'map'"])))
            continue
        words[word], column = 0, line.rfind(value) + 1
        if word == "type" and value != "octile":
            faults.append(Fault(number, column, word, quoted(value), "octile, the only type that is read"))
        elif word != "type" and not (WHOLE.fullmatch(value) and int(value)):
            faults.append(Fault(number, column, word, quoted(value), SIZE))
        elif word != "type":
            words[word] = int(value)
    return words


def _odd_letters(rows: Sequence[str], first: int) -> list[Fault]:
    """Letters that no map has: each once a row."""
    return [
        Fault(number, row.index(letter) + 1, "", repr(letter), LETTERS)
        for number, row in enumerate(rows, first)
        for letter in dict.fromkeys(STRANGE.findall(row))
    ]


def _odd_sizes(rows: Sequence[str], height: int, width: int, first: int) -> list[Fault]:
    """Rows that are too short or too long, too few or too many; or too many cells for any map."""
    if height * width > MOST_CELLS:
        return [Fault(1, 1, "", f"{height * width:,} cells", f"at most {MOST_CELLS:,}")]
    faults = [
        Fault(number, min(len(row), width) + 1, "", f"{len(row)} letters", f"{width}, the width")
        for number, row in enumerate(rows, first)
        if len(row) != width
    ]
    if len(rows) != height:
        place = first + min(len(rows), height)
        faults.append(Fault(place, 1, "", f"{len(rows)} rows", f"{height}, the height"))
    return faults
