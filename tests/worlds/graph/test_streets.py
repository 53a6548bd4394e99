"""The streets of small maps that are drawn as text, and of a real one."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
import pytest

import fogbench
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.families.graph_file import GraphFile
from fogbench.worlds.graph.streets import streets, thinned
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array, MapError

CROSS = """
    @@@@@.@@@@@
    @@@@@.@@@@@
    @@@@@.@@@@@
    ...........
    @@@@@.@@@@@
    @@@@@.@@@@@
    @@@@@.@@@@@
"""

BLOCK = """
    ...........
    .@@@@@@@@@.
    .@@@@@@@@@.
    .@@@@@@@@@.
    ...........
    .@@@@@@@@@@
    .@@@@@@@@@@
    .@@@@@@@@@@
"""

ISLAND = """
    @@@.......@@@@@@
    @@@.@@@@@.@@@@@@
    @@@.@@@@@.@@@@@@
    .............@..
    @@@.@@@@@.@@@@@@
    @@@.@@@@@.@@@@@@
    @@@.@@@@@.@@@@@@
"""

TYPE = "type octile\nheight 7\nwidth 11\nmap\n"


def drawn(text: str) -> Array:
    """A map [H, W], True where blocked."""
    return np.array([list(row) for row in text.split()]) == "@"


def lengths(graph: Any) -> dict[frozenset[str], float]:
    """Of the edges, by their ends."""
    return {frozenset(edge[:2]): edge[2] for edge in graph.edges(data="length")}


def test_a_crossing_has_four_streets() -> None:
    """Its arms are as long as they are in cells; y points upwards."""
    graph = streets(drawn(CROSS))
    middle, ends = "5,3", {"5,0": 3, "5,6": 3, "0,3": 5, "10,3": 5}
    assert lengths(graph) == {frozenset({middle, end}): length for end, length in ends.items()}
    assert graph.nodes["5,0"] == {"x": 5.0, "y": 6.0}
    assert graph.nodes[middle] == {"x": 5.0, "y": 3.0}


def test_a_bend_is_no_node() -> None:
    """Round a block leads a loop, which is none either; what is left is a street from a crossing to its end."""
    graph = streets(drawn(BLOCK))
    assert lengths(graph) == {frozenset({"0,4", "0,7"}): 3.0}


def test_the_largest_part_counts() -> None:
    """What no street leads to is left out; of two ways between the same crossings the shorter one is an edge."""
    graph = streets(drawn(ISLAND))
    left, right = "3,3", "9,3"
    arms = {(left, "0,3"), (left, "3,6"), (right, "12,3"), (right, "9,6")}
    assert lengths(graph) == {frozenset(arm): 3.0 for arm in arms} | {frozenset({left, right}): 6.0}


@pytest.mark.parametrize("width", [2, 3, 4, 5, 6])
def test_wide_streets_meet_in_one_node(width: int) -> None:
    """Whatever their width, four arms of 20 cells meet once, and reach into their ends."""
    side = 40 + width
    blocked = np.ones((side, side), np.bool_)
    blocked[20 : 20 + width] = blocked[:, 20 : 20 + width] = False
    graph = streets(blocked)
    assert sorted(count for _, count in graph.degree) == [1, 1, 1, 1, 4]
    for _, _, length in graph.edges(data="length"):
        assert 20 - width <= length <= 20 + width


def test_lines_are_thin_and_hang_together() -> None:
    """Of 50 random maps: middle lines are free, in as many parts as the map, and nothing is left to thin."""
    from scipy.ndimage import label  # noqa: PLC0415  no other test needs it

    everywhere = np.ones((3, 3))
    for seed in range(50):
        rough = np.random.default_rng(seed).random((8, 8)) < 0.6
        free = np.kron(rough, np.ones((4, 4))).astype(np.bool_)
        lines = thinned(free)
        assert (lines <= free).all()
        assert label(lines, everywhere)[1] == label(free, everywhere)[1]
        assert (thinned(lines) == lines).all()
        assert lines.sum() < 0.5 * free.sum()


def test_a_map_without_a_street_is_told() -> None:
    """In one line."""
    for text in ("@@@\n@@@", "@@@\n@.@"):
        with pytest.raises(Mistake) as caught:
            streets(drawn(text))
        assert str(caught.value) == "got a map without a street; expected two crossings or dead ends at least"


def command(*words: Any) -> tuple[int, str]:
    """How the script ends, and what it says."""
    line = [sys.executable, "-m", "fogbench.worlds.graph.streets", *map(str, words)]
    environment = {**os.environ, "PYTHONPATH": str(Path(fogbench.__file__).parents[1])}
    done = subprocess.run(line, capture_output=True, text=True, env=environment, check=False)
    return done.returncode, done.stdout + done.stderr


def test_the_script_writes_a_file_that_is_played_on(tmp_path: Path) -> None:
    """It says how large the graph is, and where it wrote it; a broken map is told without a traceback."""
    (tmp_path / "a.map").write_text(TYPE + "\n".join(CROSS.split()) + "\n")
    out = tmp_path / "a.graphml"
    assert command(tmp_path / "a.map", out) == (0, f"{out}: 5 nodes, 4 edges\n")
    conditions = GraphConditions.model_validate({"budget": {"steps": 9}})
    world = GraphFile(file=out, start="0,3", goal="10,3").sample(np.random.default_rng(0), 0, conditions)
    assert (world.shortest(), world.straight()) == (10.0, 10.0)
    (tmp_path / "a.map").write_text(TYPE)
    code, text = command(tmp_path / "a.map", out)
    assert code == 2
    assert "got 0 rows; expected 7, the height." in text
    assert "Traceback" not in text


def test_a_city_map_is_played_on_as_it_is(tmp_path: Path) -> None:
    """The same graph as that of the file; a map without streets is told with its place."""
    (tmp_path / "a.map").write_text(TYPE + "\n".join(CROSS.split()) + "\n")
    nx.write_graphml(streets(drawn(CROSS)), tmp_path / "a.graphml")
    (direct, _, names), (file, _, same) = (
        (read.graph, read.notes, read.numbers)
        for read in (GraphFile(file=tmp_path / name)._read() for name in ("a.map", "a.graphml"))
    )
    assert names == same
    for part in ("starts", "ends", "lengths", "coordinates"):
        assert np.array_equal(getattr(direct, part), getattr(file, part))
    (tmp_path / "b.map").write_text("type octile\nheight 1\nwidth 1\nmap\n.\n")
    with pytest.raises(MapError) as caught:
        GraphFile(file=tmp_path / "b.map")._read()
    expected = "got a map without a street; expected two crossings or dead ends at least"
    assert str(caught.value) == f"{tmp_path}/b.map: {expected}"


@pytest.mark.maps
def test_the_crossings_of_a_real_city(tmp_path: Path) -> None:
    """Berlin's are connected, some dozens, and no street is shorter than the straight line between its ends."""
    out = tmp_path / "Berlin_0_256.graphml"
    code, text = command(Path(os.environ["FOGBENCH_MAPS"], "movingai", "Berlin_0_256.map"), out)
    assert code == 0, text
    graph = nx.read_graphml(out)
    assert nx.is_connected(graph)
    assert 40 < len(graph) < 100
    assert GraphFile(file=out)._read().graph.size == len(graph)
