"""Graphs from files, as networkx and osmnx write them, and what is said of those that cannot be played on."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
import pytest
from pydantic import ValidationError

from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.families.graph_file import ONE_TASK, GraphFile
from fogbench.worlds.graph.graph import Graph
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.types import MapError

OPEN = GraphConditions.model_validate({"budget": {"steps": 100}})


def play(file: Path, **fields: Any) -> GraphWorld:
    """A world on the graph of a file."""
    return GraphFile(file=file, **fields).sample(np.random.default_rng(0), 0, OPEN)


def edges(graph: Graph) -> set[tuple[int, int, float]]:
    """Of a graph, with their lengths."""
    rows = ((node, range(graph.starts[node], graph.starts[node + 1])) for node in range(graph.size))
    return {(node, int(graph.ends[k]), float(graph.lengths[k])) for node, row in rows for k in row}


@pytest.mark.parametrize("form", ["unit", "lengths", "coordinates"])
def test_graphml_of_networkx_is_read(weave: Callable[..., Any], form: str, tmp_path: Path) -> None:
    """What networkx writes comes back: nodes in their order, edges, lengths and coordinates."""
    for seed in range(20):
        source = weave(np.random.default_rng(seed), form)
        nx.write_graphml(source, tmp_path / "a.graphml")
        graph = play(tmp_path / "a.graphml").graph
        expected = {(a, b, edge.get("length", 1)) for a, b, edge in source.edges(data=True)}
        assert edges(graph) == expected | {(b, a, length) for a, b, length in expected}
        assert graph.coordinates.tolist() == [[n["x"], n["y"]] if n else [] for _, n in source.nodes(data=True)]


WRITERS: dict[str, tuple[Callable[..., None], bool]] = {
    "nodes alone": (partial(nx.write_edgelist, data=False), False),
    "dictionaries": (nx.write_edgelist, True),
    "values": (partial(nx.write_edgelist, data=["length"]), True),
    "weights": (nx.write_weighted_edgelist, True),
}


@pytest.mark.parametrize("writer", WRITERS)
def test_edge_lists_of_networkx_are_read(weave: Callable[..., Any], writer: str, tmp_path: Path) -> None:
    """In all its forms; a node is called what stands there."""
    write, tells = WRITERS[writer]
    source = nx.relabel_nodes(weave(np.random.default_rng(5), "lengths"), "node{}".format)
    nx.set_edge_attributes(source, {(a, b): {"weight": length} for a, b, length in source.edges(data="length")})
    write(source, tmp_path / "a.edgelist")
    (tmp_path / "a.edgelist").write_bytes(b"# roads\n\n" + (tmp_path / "a.edgelist").read_bytes())
    read = GraphFile(file=tmp_path / "a.edgelist")._read()
    directed = [(read.numbers[a], read.numbers[b], edge) for a, b, edge in source.to_directed().edges(data="length")]
    assert edges(read.graph) == {(a, b, float(length) if tells else 1.0) for a, b, length in directed}


def test_a_street_network_of_osmnx_is_read(tmp_path: Path) -> None:
    """Directed, both ways of a street, several streets between two crossings, all attributes as text, degrees."""
    source: Any = nx.MultiDiGraph(crs="epsg:4326", created_date="2026-01-01", simplified="True")
    for name, x, y in ((240109189, 13.40, 52.51), (240109190, 13.41, 52.51), (26960761, 13.41, 52.52)):
        source.add_node(name, x=str(x), y=str(y), street_count="3")
    source.add_edge(240109189, 240109190, length="700.5", oneway="False", osmid="1")
    source.add_edge(240109190, 240109189, length="700.5", oneway="False", osmid="1")
    source.add_edge(240109190, 26960761, length="1200.25", geometry="LINESTRING (13.41 52.51, 13.41 52.52)")
    source.add_edge(240109190, 26960761, length="1115", oneway="True")
    source.add_edge(26960761, 26960761, length="90", name="Loop")
    nx.write_graphml(source, tmp_path / "a.graphml")
    family = GraphFile(file=tmp_path / "a.graphml", both_ways=True, start="26960761", goal="240109189")
    world = family.sample(np.random.default_rng(0), 0, OPEN)
    assert edges(world.graph) == {(0, 1, 700.5), (1, 0, 700.5), (1, 2, 1115.0), (2, 1, 1115.0)}
    assert (world.shortest(), world.hops) == (1815.5, 2)
    assert world.straight() == pytest.approx(np.hypot(677.0, 1111.9), rel=1e-3)
    assert family.notes() == [
        f"{tmp_path}/a.graphml: 1 edge from a node to itself is left out",
        f"{tmp_path}/a.graphml: of edges between the same nodes the shortest counts, 2 are left out",
        f"{tmp_path}/a.graphml: {ONE_TASK}",
    ]


def test_start_and_goal_fix_the_task(tmp_path: Path) -> None:
    """By their names in the file; without them both are uniform over its nodes."""
    nx.write_edgelist(nx.relabel_nodes(nx.path_graph(4), dict(enumerate("dabc"))), tmp_path / "a.edgelist")
    fixed = [play(tmp_path / "a.edgelist", start="c", goal="d") for _ in range(3)]
    assert {(world.start, world.task.goal, world.shortest()) for world in fixed} == {(3, 0, 3.0)}
    family = GraphFile(file=tmp_path / "a.edgelist")
    drawn = [family.sample(np.random.default_rng(seed), 0, OPEN) for seed in range(200)]
    assert len({(world.start, world.task.goal) for world in drawn}) == 12
    assert family.notes() == []


def test_words_are_those_of_the_contents(tmp_path: Path) -> None:
    """The same graph elsewhere is the same; another under the same name is another."""
    for folder, nodes in (("one", 4), ("two", 4), ("three", 5)):
        (tmp_path / folder).mkdir()
        nx.write_edgelist(nx.path_graph(nodes), tmp_path / folder / "a.edgelist")
    one, two, three = (GraphFile(file=tmp_path / name / "a.edgelist").words() for name in ("one", "two", "three"))
    assert one == two != three


def graphml(source: Any) -> bytes:
    """A graph as networkx writes it."""
    return "\n".join(nx.generate_graphml(source)).encode()


PATH = graphml(nx.path_graph(3))

PLACED: Any = nx.path_graph(3)
nx.set_node_attributes(PLACED, {0: 13.40, 1: 13.41, 2: 13.42}, "x")
nx.set_node_attributes(PLACED, 52.5, "y")

SHORT = PLACED.copy()
nx.set_edge_attributes(SHORT, 0.005, "length")

ALONE = nx.path_graph(3)
ALONE.add_node("far away")

ODD: dict[str, tuple[str, bytes, dict[str, Any], str]] = {
    "in parts": (
        "a.edgelist",
        b"a b\nc d\ne f\n",
        {},
        "got 3 parts that no edge joins; expected one",
    ),
    "an isolated node": (
        "a.graphml",
        graphml(ALONE),
        {},
        "node far away: got no edge; expected a path from each node to each other",
    ),
    "a node that leads to itself alone": (
        "a.edgelist",
        b"a b\nc c\n",
        {},
        "node c: got no edge; expected a path from each node to each other",
    ),
    "directed": (
        "a.graphml",
        graphml(nx.DiGraph([(0, 1)])),
        {},
        "got a directed graph; expected edges that lead both ways, or `both_ways: true` to read them so",
    ),
    "too large": (
        "a.edgelist",
        b"\n".join(b"%d %d" % (node, node + 1) for node in range(100_000)),
        {},
        "got 100,001 nodes; expected at most 100,000",
    ),
    "empty": ("a.edgelist", b"", {}, "got 0 nodes; expected at least 2"),
    "one node": ("a.edgelist", b"a a\n", {}, "got 1 node; expected at least 2"),
    "broken XML": (
        "a.graphml",
        PATH[:-20],
        {},
        "ParseError: no element found: line 8, column 1",
    ),
    "other XML": ("a.graphml", b"<a/>", {}, "NetworkXError: file not successfully read as graphml"),
    "no XML": ("a.graphml", b"a b\n", {}, "ParseError: syntax error: line 1, column 0"),
    "no data": (
        "a.edgelist",
        b"a b c\n",
        {},
        "TypeError: Failed to convert weight data c to type <class 'float'>.",
    ),
    "too much data": (
        "a.edgelist",
        b"a b 1 2\n",
        {},
        "TypeError: Failed to convert edge data (['1', '2']) to dictionary.",
    ),
    "length 0": (
        "a.edgelist",
        b"a b {'length': 0}\n",
        {},
        "edge a - b: got a length of 0; expected a number above 0",
    ),
    "no number": (
        "a.edgelist",
        b"a b {'length': 'far'}\n",
        {},
        "got far as an edge's length; expected a number",
    ),
    "another unit": (
        "a.graphml",
        graphml(SHORT),
        {},
        (
            "edge 0 - 1: got a length of 0.005; expected at least the straight line of 0.01 between its nodes, "
            "in the same unit"
        ),
    ),
    "unknown start": (
        "a.edgelist",
        b"anna berta\nberta carla\n",
        {"start": "ana", "goal": "carla"},
        "start: got ana; expected a node of the file. Did you mean anna?",
    ),
    "unknown goal": (
        "a.edgelist",
        b"anna berta\nberta carla\n",
        {"start": "anna", "goal": "xyz"},
        "goal: got xyz; expected a node of the file.",
    ),
    "goal is start": (
        "a.edgelist",
        b"a b\n",
        {"start": "a", "goal": "a"},
        "goal a: got the node of the start; expected another",
    ),
}


@pytest.mark.parametrize("odd", ODD)
def test_what_cannot_be_played_on_is_told(odd: str, tmp_path: Path) -> None:
    """One line: the file, what was got, what was expected."""
    name, contents, fields, told = ODD[odd]
    (tmp_path / name).write_bytes(contents)
    with pytest.raises(MapError) as caught:
        play(tmp_path / name, **fields)
    assert str(caught.value) == f"{tmp_path / name}: {told}"


def test_tasks_out_of_bounds_are_told(tmp_path: Path) -> None:
    """A fixed one that does not fit, and bounds that none fits."""
    nx.write_edgelist(nx.path_graph(4), tmp_path / "a.edgelist")
    far = GraphConditions.model_validate({"budget": {"steps": 9}, "tasks": {"distance": [9, 10]}})
    wanted = "an optimum of 9 to 10 (set by `tasks: {distance: ...}`)"
    for fields, told in (
        ({"start": "0", "goal": "3"}, f"goal 3: got a task out of bounds; expected {wanted}"),
        ({}, f"no task with {wanted} was found"),
    ):
        with pytest.raises(MapError) as caught:
            GraphFile(file=tmp_path / "a.edgelist", **fields).sample(np.random.default_rng(0), 0, far)
        assert str(caught.value) == f"{tmp_path}/a.edgelist: {told}"


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"file": "a.txt"}, "a file that ends in .graphml, .edgelist, .map"),
        ({"file": "a.graphml", "start": "a"}, "start and goal, or neither"),
    ],
)
def test_mistakes_in_settings_are_told(fields: dict[str, Any], told: str) -> None:
    """What is expected."""
    with pytest.raises(ValidationError) as caught:
        GraphFile.model_validate(fields)
    assert [str(error["ctx"]["error"]) for error in caught.value.errors()] == [told]
