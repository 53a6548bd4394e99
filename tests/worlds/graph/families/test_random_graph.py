"""Drawn graphs: connected, as dense as asked, their trees uniform; and those of networkx's generators."""

from collections import Counter
from typing import Any

import networkx as nx
import numpy as np
import pytest
from pydantic import ValidationError
from scipy.stats import chisquare

from fogbench.worlds.draws import luck
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.families.random_graph import RandomGraph, tree
from fogbench.worlds.graph.graph import Graph
from fogbench.worlds.types import MapError


def networkx_of(graph: Graph) -> Any:
    """The graph of networkx with the same edges."""
    made: Any = nx.empty_graph(graph.size)
    made.add_edges_from(graph.lines.tolist())
    return made


def draw(seed: int, **fields: Any) -> Graph:
    """A graph of some settings."""
    return RandomGraph.model_validate(fields).draw(np.random.default_rng(seed))


@pytest.mark.parametrize(
    ("fields", "edges"),
    [
        ({"nodes": 2, "mean_degree": 1}, 1),
        ({"nodes": 16, "mean_degree": 3}, 24),
        ({"nodes": 16, "mean_degree": 1}, 15),
        ({"nodes": 101, "mean_degree": 4.5}, 227),
        ({"nodes": 20, "density": 0.5}, 95),
        ({"nodes": 20, "density": 0}, 19),
        ({"nodes": 20, "density": 1}, 190),
    ],
)
def test_a_drawn_graph_has_the_edges_that_are_asked_for(fields: dict[str, Any], edges: int) -> None:
    """Their mean degree or density, rounded, or those of a tree; different ones, and all nodes connected."""
    for seed in range(30):
        graph = draw(seed, **fields)
        source = networkx_of(graph)
        assert len(graph.lines) == source.number_of_edges() == edges
        assert graph.unit
        assert nx.is_connected(source)
        assert nx.number_of_selfloops(source) == 0


def test_trees_are_uniform() -> None:
    """Each of the 16 labelled trees on 4 nodes comes as often, by the chi-square test of 8000."""
    rng, counts = np.random.default_rng(1), Counter[frozenset[Any]]()
    edges = np.empty((3, 2), np.int32)
    for _ in range(8000):
        tree(luck(rng), 4, edges)
        counts[frozenset(frozenset(edge) for edge in edges.tolist())] += 1
    assert len(counts) == 16
    assert chisquare(list(counts.values())).pvalue > 0.01


@pytest.mark.parametrize("size", [2, 3, 5, 50])
def test_a_tree_is_a_tree(size: int) -> None:
    """Whatever its size: connected, by one edge less than nodes."""
    for seed in range(50):
        edges = np.empty((size - 1, 2), np.int32)
        tree(luck(np.random.default_rng(seed)), size, edges)
        assert nx.is_tree(nx.Graph(edges.tolist()))


def test_more_edges_are_uniform() -> None:
    """On 4 nodes with 4 edges, pairs beside a tree come as often, by the chi-square test of 6000."""
    counts = Counter(tuple(line) for seed in range(6000) for line in draw(seed, nodes=4, mean_degree=2).lines.tolist())
    assert len(counts) == 6
    assert chisquare(list(counts.values())).pvalue > 0.01


@pytest.mark.parametrize(
    ("fields", "nodes"),
    [
        ({"nodes": 20, "generator": "watts_strogatz_graph", "parameters": {"k": 4, "p": 0.1}}, 20),
        ({"nodes": 20, "generator": "barabasi_albert_graph", "parameters": {"m": 2}}, 20),
        ({"nodes": 20, "generator": "random_geometric_graph", "parameters": {"radius": 0.4}}, 20),
        ({"nodes": 9, "generator": "random_labeled_tree"}, 9),
        ({"generator": "grid_2d_graph", "parameters": {"m": 4, "n": 5}}, 20),
        ({"generator": "balanced_tree", "parameters": {"r": 2, "h": 3}}, 15),
        ({"generator": "complete_multipartite_graph", "parameters": {"subset_sizes": [2, 3, 4]}}, 9),
        ({"generator": "random_degree_sequence_graph", "parameters": {"sequence": [2, 2, 2, 1, 1]}}, 5),
        ({"generator": "karate_club_graph"}, 34),
    ],
)
def test_any_generator_of_networkx_makes_graphs(fields: dict[str, Any], nodes: int) -> None:
    """By its name and its parameters: connected ones, the same for the same luck."""
    for seed in range(5):
        graph, again = draw(seed, **fields), draw(seed, **fields)
        assert graph.size == nodes
        assert nx.is_connected(networkx_of(graph))
        assert graph.ends.tolist() == again.ends.tolist()
        assert graph.coordinates.tolist() == again.coordinates.tolist()


def test_nodes_of_a_generator_are_shuffled() -> None:
    """A path of networkx is one of 0, 1, 2, ...; here each node comes as often at its end, with its coordinates."""
    ends = Counter(
        node
        for seed in range(1000)
        for graph in [draw(seed, generator="path_graph", nodes=5)]
        for node in range(5)
        if len(graph.row(node)) == 1
    )
    assert chisquare([ends[node] for node in range(5)]).pvalue > 0.01
    grid = draw(3, generator="grid_2d_graph", parameters={"m": 3, "n": 4})
    assert sorted(grid.coordinates.tolist()) == [[x, y] for x in range(3) for y in range(4)]
    assert all(grid.straight(a, b) == 1 for a, b in grid.lines.tolist())
    assert grid.coordinates.tolist() != sorted(grid.coordinates.tolist())


MISTAKES = {
    "no way": ({"nodes": 9}, "one of mean_degree, density, generator (got none)"),
    "two ways": (
        {"nodes": 9, "mean_degree": 3, "density": 0.1},
        "one of mean_degree, density, generator (got mean_degree and density)",
    ),
    "no nodes": ({"mean_degree": 3}, "nodes"),
    "foreign parameters": (
        {"nodes": 9, "mean_degree": 3, "parameters": {"k": 2}},
        "no parameters, which are those of a generator",
    ),
    "more edges than pairs": (
        {"nodes": 9, "mean_degree": 8.3},
        "at most every pair of nodes once (these settings make 37 edges)",
    ),
    "too many edges": (
        {"nodes": 100_000, "mean_degree": 30},
        "at most 1,000,000 edges (these settings make 1,500,000 edges)",
    ),
    "unknown generator": (
        {"nodes": 9, "generator": "watts_strogatz"},
        "a function of networkx that makes a graph (it has no watts_strogatz)",
    ),
    "unknown parameter": (
        {"nodes": 9, "generator": "watts_strogatz_graph", "parameters": {"k": 4, "q": 0.1}},
        "parameters of watts_strogatz_graph: n, k, p (it has no q)",
    ),
    "missing parameter": (
        {"nodes": 9, "generator": "watts_strogatz_graph", "parameters": {"k": 4}},
        "all parameters of watts_strogatz_graph (p is missing)",
    ),
    "missing row of parameters": (
        {"generator": "complete_multipartite_graph"},
        "all parameters of complete_multipartite_graph (subset_sizes is missing)",
    ),
    "missing parameters": (
        {"nodes": 9, "generator": "watts_strogatz_graph"},
        "all parameters of watts_strogatz_graph (k and p are missing)",
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes_in_settings_are_told(mistake: str) -> None:
    """What is expected, and what there is instead."""
    fields, told = MISTAKES[mistake]
    with pytest.raises(ValidationError) as caught:
        RandomGraph.model_validate(fields)
    assert [str(error["ctx"]["error"]) for error in caught.value.errors()] == [told]


@pytest.mark.parametrize(
    ("fields", "near"),
    [
        ({"generator": "watts_strogatz"}, "watts_strogatz_graph"),
        ({"generator": "Grid_2D_graph"}, "grid_2d_graph"),
        ({"generator": "random_labelled_tree"}, "random_labeled_tree"),
        ({"generator": "xyzzy"}, ""),
        ({"generator": "random_geometric_graph", "parameters": {"n": 9, "radios": 1}}, "radius"),
    ],
)
def test_the_nearest_name_is_told(fields: dict[str, Any], near: str) -> None:
    """Of generators and their parameters; none where none is like it."""
    with pytest.raises(ValidationError) as caught:
        RandomGraph.model_validate(fields)
    (error,) = caught.value.errors()
    assert error["ctx"]["error"].near == near


@pytest.mark.parametrize(
    ("name", "nodes", "parameters", "told"),
    [
        ("watts_strogatz_graph", 9, {"k": 40, "p": 0.1}, "NetworkXError: k>n, choose smaller k or larger n"),
        ("complete_multipartite_graph", None, {"subset_sizes": 9}, "TypeError: 'int' object is not iterable"),
        ("empty_graph", 9, {}, "got graphs that are not connected, or of one node; expected one that is"),
        (
            "gnp_random_graph",
            9,
            {"p": 0.01},
            "got graphs that are not connected, or of one node; expected one that is, in 100 tries",
        ),
        (
            "gnp_random_graph",
            9,
            {"p": 0.4, "directed": True},
            "got a DiGraph; expected a graph whose edges lead both ways",
        ),
        ("grid_2d_graph", 400, {"m": 400}, "got 160,000 nodes; expected at most 100,000."),
    ],
)
def test_generators_that_make_no_graph_are_told(
    name: str, nodes: int | None, parameters: dict[str, Any], told: str
) -> None:
    """In one line, whatever networkx raises."""
    with pytest.raises(MapError) as caught:
        draw(0, nodes=nodes, generator=name, parameters=parameters)
    assert str(caught.value) == f"{name}: {told}"


def test_tasks_that_never_fit_are_given_up() -> None:
    """After a thousand graphs, with what was wanted."""
    conditions = GraphConditions.model_validate({"budget": {"steps": 9}, "tasks": {"distance": [9, 9]}})
    with pytest.raises(MapError) as caught:
        RandomGraph(nodes=5, mean_degree=2).sample(np.random.default_rng(0), 0, conditions)
    wanted = "an optimum of 9 to 9 (set by `tasks: {distance: ...}`)"
    assert str(caught.value) == f"RandomGraph: no task with {wanted} was found on 1000 graphs"


def test_without_bounds_every_task_can_be_done_in_its_steps() -> None:
    """The fewest edges to the goal are at most the step budget, and all of those are drawn."""
    conditions = GraphConditions.model_validate({"budget": {"steps": 3}})
    family = RandomGraph(nodes=30, mean_degree=2.2)
    worlds = [family.sample(np.random.default_rng(seed), seed, conditions) for seed in range(50)]
    assert {world.hops for world in worlds} == {1, 2, 3}
