"""Graphs of networkx become ours: nodes in their order, each edge once, lengths, coordinates."""

from collections.abc import Callable
from typing import Any

import networkx as nx
import numpy as np
import pytest

from fogbench.worlds.graph.networks import converted
from fogbench.worlds.mistake import Mistake


@pytest.mark.parametrize("form", ["unit", "lengths", "coordinates"])
def test_a_graph_is_kept_whole(weave: Callable[..., Any], form: str) -> None:
    """The rows of 100 random graphs are those of networkx, in rising order; nothing of them can be written."""
    for seed in range(100):
        source = weave(np.random.default_rng(seed), form)
        graph = converted(source).graph
        assert graph.unit == all(edge.get("length", 1) == 1 for _, _, edge in source.edges(data=True))
        for node in source:
            row = {other: edge.get("length", 1) for other, edge in source.adj[node].items()}
            first, last = graph.starts[node], graph.starts[node + 1]
            assert graph.ends[first:last].tolist() == graph.row(node).tolist() == sorted(row)
            assert graph.lengths[first:last].tolist() == [row[other] for other in sorted(row)]
        assert {tuple(line) for line in graph.lines.tolist()} == {tuple(sorted(edge)) for edge in source.edges}
        for array in (graph.starts, graph.ends, graph.lengths, graph.coordinates):
            assert not array.flags.writeable


def test_of_several_edges_the_shortest_counts() -> None:
    """Between two nodes, whichever way they lead; one from a node to itself does not count."""
    source: Any = nx.MultiDiGraph()
    source.add_edges_from([("b", "a", {"length": "7.5"}), ("a", "b", {"length": 3}), ("a", "a", {"length": 1})])
    source.add_edge("b", "a", length=4.0)
    graph, names = converted(source)
    assert names == ["b", "a"]
    assert (graph.lines.tolist(), graph.lengths.tolist()) == ([[0, 1]], [3.0, 3.0])


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ([{"length": 2}, {"length": 3}], [2.0, 3.0]),
        ([{"weight": 2}, {"weight": 3}], [2.0, 3.0]),
        ([{"length": 2, "weight": 9}, {"length": 3, "weight": 9}], [2.0, 3.0]),
        ([{"length": 2, "weight": 4}, {"weight": 5}], [4.0, 5.0]),
        ([{"length": 2}, {}], [1.0, 1.0]),
    ],
)
def test_lengths_count_where_all_edges_have_them(attributes: list[dict[str, Any]], expected: list[float]) -> None:
    """`length` before `weight`; if one edge says nothing, all are 1."""
    source: Any = nx.Graph([(0, 1, attributes[0]), (1, 2, attributes[1])])
    assert converted(source).graph.lengths.tolist() == [expected[0], *expected, expected[1]]


def test_edges_are_straight_where_nodes_have_coordinates() -> None:
    """By `x` and `y`, by `pos`, or by names that are pairs; three-dimensional ones are none."""
    plain: Any = nx.Graph([("a", "b")])
    plain.nodes["a"].update(x="0", y="1")
    plain.nodes["b"].update(x=3.0, y=5)
    placed: Any = nx.Graph([(0, 1)])
    placed.nodes[0]["pos"], placed.nodes[1]["pos"] = (0, 1), [3, 5]
    for source in (plain, placed, nx.Graph([((0, 1), (3, 5))])):
        graph = converted(source).graph
        assert graph.coordinates.tolist() == [[0, 1], [3, 5]]
        assert graph.lengths.tolist() == [5.0, 5.0]
        assert graph.straight(0, 1) == 5.0
    flat = converted(nx.Graph([((0, 1, 2), (3, 5, 2))])).graph
    assert (flat.coordinates.shape, flat.lengths.tolist(), flat.straight(0, 1)) == ((2, 0), [1.0, 1.0], 0.0)


def test_degrees_become_metres() -> None:
    """On the plane that touches the earth amid the nodes, a hundredth of a degree is as long as on a sphere."""
    corners = [(13.40, 52.51), (13.41, 52.51), (13.40, 52.53)]
    source: Any = nx.Graph(crs="EPSG:4326")
    for node, (x, y) in enumerate(corners):
        source.add_node(node, x=x, y=y)
    source.add_edges_from([(0, 1), (0, 2), (1, 2)])
    graph = converted(source).graph
    for a, b in ((0, 1), (0, 2), (1, 2)):
        assert graph.straight(a, b) == pytest.approx(haversine(*corners[a], *corners[b]), rel=1e-3)


def haversine(*degrees: float) -> float:
    """The way over a sphere as large as the earth [m]."""
    x, y, u, v = np.deg2rad(degrees)
    chord = np.sin((v - y) / 2) ** 2 + np.cos(y) * np.cos(v) * np.sin((u - x) / 2) ** 2
    return float(2 * 6_371_009 * np.arcsin(np.sqrt(chord)))


@pytest.mark.parametrize(
    ("nodes", "edge", "told"),
    [
        ({}, {"length": 0}, "edge a - b: got a length of 0; expected a number above 0"),
        ({}, {"length": -2.5}, "edge a - b: got a length of -2.5; expected a number above 0"),
        ({}, {"length": "far"}, "got far as an edge's length; expected a number"),
        ({}, {"weight": "nan"}, "got nan as an edge's weight; expected a number"),
        ({}, {"length": "inf"}, "got inf as an edge's length; expected a number"),
        (
            {"a": {"x": 0, "y": 0}, "b": {"x": 0, "y": "north"}},
            {},
            "got north as a node's coordinate; expected a number",
        ),
        (
            {"a": {"x": 13.4, "y": 52.5}, "b": {"x": 13.5, "y": 52.5}},
            {"length": 0.05},
            (
                "edge a - b: got a length of 0.05; expected at least the straight line of 0.1 between its nodes, "
                "in the same unit"
            ),
        ),
        (
            {"a": {"x": 0, "y": 0}, "b": {"x": 0, "y": 0}},
            {},
            "edge a - b: got a length of 0; expected a number above 0",
        ),
    ],
)
def test_numbers_that_cannot_be_are_told(nodes: dict[str, Any], edge: dict[str, Any], told: str) -> None:
    """One line: the edge, what was got, what was expected."""
    source: Any = nx.Graph([("a", "b", edge)])
    nx.set_node_attributes(source, nodes)
    with pytest.raises(Mistake) as caught:
        converted(source)
    assert str(caught.value) == told


def test_too_large_a_graph_is_told() -> None:
    """More than a hundred thousand nodes, or a million edges."""
    with pytest.raises(Mistake) as caught:
        converted(nx.path_graph(100_001))
    assert str(caught.value) == "got 100,001 nodes; expected at most 100,000"
    with pytest.raises(Mistake) as caught:
        converted(nx.complete_graph(1415))
    assert str(caught.value) == "got 1,000,405 edges; expected at most 1,000,000"
