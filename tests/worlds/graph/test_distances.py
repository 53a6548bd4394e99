"""Shortest paths, held against networkx."""

from collections.abc import Callable
from typing import Any

import networkx as nx
import numpy as np
import pytest

from fogbench.worlds.graph.distances import FAR, distances, hops, pop, push
from fogbench.worlds.graph.graph import joined
from fogbench.worlds.graph.networks import converted, parts


@pytest.mark.parametrize("form", ["unit", "lengths", "coordinates"])
def test_shortest_paths_are_those_of_networkx(weave: Callable[..., Any], form: str) -> None:
    """Lengths and fewest edges, from a node to all others, on 200 random graphs of each form."""
    for seed in range(200):
        rng = np.random.default_rng(seed)
        source = weave(rng, form, most=40)
        graph, start = converted(source).graph, int(rng.integers(len(source)))
        expected = nx.single_source_dijkstra_path_length(source, start, weight="length")
        fewest = nx.single_source_shortest_path_length(source, start)
        assert distances(graph, start) == pytest.approx([expected[node] for node in range(len(source))])
        assert hops(graph.starts, graph.ends, start).tolist() == [fewest[node] for node in range(len(source))]


def test_what_no_path_leads_to_is_far() -> None:
    """Of two parts, one is infinitely far from the other."""
    graph = joined(4, np.array([(0, 1), (2, 3)], np.int32))
    longer = joined(4, graph.lines, np.array([2.0, 3.0]))
    assert distances(graph, 0).tolist() == [0, 1, np.inf, np.inf]
    assert distances(longer, 3).tolist() == [np.inf, np.inf, 3, 0]
    assert hops(graph.starts, graph.ends, 0).tolist() == [0, 1, FAR, FAR]
    assert (parts(graph), parts(joined(1, np.empty((0, 2), np.int32)))) == (2, 1)


def test_a_heap_hands_out_what_it_holds_in_order() -> None:
    """300 entries of three numbers, of which many are equal, pushed and popped by turns."""
    rng = np.random.default_rng(0)
    heap, waiting, held = np.empty((301, 3)), 0, []
    for entry in rng.integers(4, size=(300, 3)).astype(float):
        waiting = push(heap, waiting, tuple(entry))
        held.append(tuple(entry))
        if rng.random() < 0.4:
            assert tuple(heap[0]) == min(held)
            held.remove(min(held))
            waiting = pop(heap, waiting)
    for entry in sorted(held):
        assert tuple(heap[0]) == entry
        waiting = pop(heap, waiting)
    assert waiting == 0
