"""The Moving AI Lab's files."""

import math
import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from fogbench.worlds.maps.distances import distances
from fogbench.worlds.maps.files.octile import read_map
from fogbench.worlds.maps.files.scen import Trip, read_scen
from fogbench.worlds.types import Array, Cell, MapError

PATH = Path("x.map")
MAP = b"type octile\nheight 3\nwidth 4\nmap\n..@.\nG.TS\n.OW.\n"
SCEN = b"version 1\n0\tx.map\t4\t3\t0\t2\t3\t1\t5.5\n"
SLACK = 1e-3
BENCHMARKS = ["Berlin_0_256", "Boston_2_512", "Denver_1_256"]


def test_a_map_by_hand() -> None:
    """Ground `.` `G` and swamp `S` are free; `@` `O` `T` and water `W` are blocked; nobody can change the map."""
    blocked = read_map(PATH, MAP)
    assert blocked.tolist() == [[False, False, True, False], [False, False, True, False], [False, True, True, False]]
    assert not blocked.flags.writeable
    assert np.array_equal(read_map(PATH, MAP.replace(b"\n", b"\r\n")), blocked)


@pytest.mark.parametrize("separator", [b"\t", b" "])
def test_a_task_list_by_hand(separator: bytes) -> None:
    """The file's x is a column and its y is a row; fields are separated by tabs or by spaces."""
    trips = read_scen(Path("x.scen"), SCEN.replace(b"\t", separator), (3, 4))
    assert trips == (Trip(line=2, map="x.map", start=(2, 0), goal=(1, 3), octile=5.5),)


def complaint(read: Callable[[Path, bytes], Any], contents: bytes) -> str:
    """What a reader says of a broken file; nothing of a good one."""
    try:
        read(Path("x"), contents)
    except MapError as error:
        return str(error)
    return ""


@given(place=st.integers(0, 60), cut=st.integers(0, 3), put=st.binary(max_size=3))
def test_no_damage_ends_in_another_error(place: int, cut: int, put: bytes) -> None:
    """A few bytes cut out of, or put into, a file leave it readable or raise a MapError of lines with their places."""
    for read, contents in ((read_map, MAP), (lambda path, text: read_scen(path, text, (3, 4)), SCEN)):
        text = complaint(read, contents[:place] + put + contents[place + cut :])
        for line in text.splitlines():
            assert re.fullmatch(
                r"x:[0-9]+:[0-9]+  (\w+: )?(got .+; expected|missing; give) .+\.|x: [0-9]+ more .+", line
            )


def benchmark(name: str) -> tuple[Array, tuple[Trip, ...]]:
    """A real map with its tasks."""
    path = Path(os.environ["FOGBENCH_MAPS"], "movingai", f"{name}.map")
    scen = Path(f"{path}.scen")
    blocked = read_map(path, path.read_bytes())
    return blocked, read_scen(scen, scen.read_bytes(), blocked.shape)


def shortest(blocked: Array, steps: list[tuple[int, int]], tasks: list[tuple[Cell, Cell, float]]) -> Iterator[float]:
    """Shortest lengths over free cells, by scipy; steps cut no corner and go both ways; infinite where none is as told.

    Args:
        blocked: [H, W] bool.
        steps: rows and columns, one direction of each.
        tasks: start, goal, and a length. The search is kept to the cells through which a path of that length could
            lead if nothing were in the way.
    """
    free = np.pad(~blocked, 1)  # [H + 2, W + 2], so that no step leaves the array
    node = np.cumsum(free).reshape(free.shape) - 1
    edges = []
    for down, right in steps:
        sides = ((-down, 0), (0, -right), (-down, -right))
        ok = np.logical_and.reduce([free, *(np.roll(free, side, (0, 1)) for side in sides)])
        edges.append((node[ok], np.roll(node, (-down, -right), (0, 1))[ok], np.full(ok.sum(), math.hypot(down, right))))
    a, b, length = map(np.concatenate, zip(*edges, strict=True))
    ends = (np.concatenate([a, b]), np.concatenate([b, a]))
    graph = coo_array((np.concatenate([length, length]), ends), shape=(free.sum(), free.sum())).tocsr()
    cells = np.argwhere(~blocked)  # [nodes, 2]
    for start, goal, told in tasks:
        around = straight(cells, start, steps) + straight(cells, goal, steps)
        within = np.flatnonzero(around <= told + SLACK)
        source, target = np.searchsorted(within, [node[1:-1, 1:-1][start], node[1:-1, 1:-1][goal]])
        yield dijkstra(graph[within][:, within], indices=source, limit=told + SLACK)[target]


def straight(cells: Array, place: Cell, steps: list[tuple[int, int]]) -> Array:
    """Lengths from a place to cells [n, 2] if nothing were in the way, with or without diagonals: [n]."""
    down, right = np.abs(cells - place).T  # [n], [n]
    diagonal = math.sqrt(2) if (1, 1) in steps else 2
    return np.asarray(np.maximum(down, right) + (diagonal - 1) * np.minimum(down, right))


@pytest.mark.maps
@pytest.mark.parametrize("name", BENCHMARKS)
def test_optima_of_real_tasks_equal_those_of_scipy(name: str) -> None:
    """For every task of a benchmark, our 4-connected optimum is what Dijkstra's search finds."""
    blocked, trips = benchmark(name)
    ours = [distances(blocked, trip.start, trip.goal)[trip.goal] for trip in trips]
    tasks = [(trip.start, trip.goal, optimum) for trip, optimum in zip(trips, ours, strict=True)]
    assert list(shortest(blocked, [(0, 1), (1, 0)], tasks)) == ours


@pytest.mark.maps
@pytest.mark.parametrize("name", BENCHMARKS)
def test_an_octile_search_finds_the_lengths_of_the_files(name: str) -> None:
    """For every task of a benchmark, an 8-connected search on our reading of the map finds the file's own length."""
    blocked, trips = benchmark(name)
    tasks = [(trip.start, trip.goal, trip.octile) for trip in trips]
    lengths = shortest(blocked, [(0, 1), (1, 0), (1, 1), (1, -1)], tasks)
    assert list(lengths) == pytest.approx([trip.octile for trip in trips], abs=1e-4)
