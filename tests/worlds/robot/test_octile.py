"""Octile lengths against an independent search, and their bound."""

from math import hypot, sqrt

import networkx as nx
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fogbench.worlds.robot.octile import CORNER, FAR, SIDE, STEPS, lengths, octile


def test_a_corner_costs_the_root_of_two_from_above() -> None:
    """So that no path is shorter than the straight line."""
    assert 0 < CORNER / SIDE - sqrt(2) < 0.00008


@given(rows=st.integers(-300, 300), columns=st.integers(-300, 300))
def test_octile_lengths_are_within_their_bound(rows: int, columns: int) -> None:
    """At least the straight line, and at most longer by what a line between a side and a corner loses, 8.25 %."""
    straight, longest = hypot(rows, columns), hypot(1, CORNER / SIDE - 1)
    assert longest < 1.0825
    assert straight <= octile(rows, columns) / SIDE <= longest * straight + 1e-9


@given(seed=st.integers(0, 2**32 - 1))
def test_lengths_are_those_of_networkx(seed: int) -> None:
    """Over cells with room, from a source that may have none."""
    rng = np.random.default_rng(seed)
    height, width = rng.integers(2, 12, 2).tolist()
    gap = rng.integers(0, 4, (height, width)).astype(np.uint16)
    source = int(rng.integers(height)), int(rng.integers(width))
    graph = nx.DiGraph()
    graph.add_nodes_from(np.ndindex(height, width))
    for row, column in np.ndindex(height, width):
        for down, right, cost in STEPS:
            r, c = row + down, column + right
            if 0 <= r < height and 0 <= c < width and gap[r, c] >= 1:
                graph.add_edge((row, column), (r, c), weight=cost)
    expected = nx.single_source_dijkstra_path_length(graph, source)
    found = lengths(gap, 1, source)
    assert {at: int(found[at]) for at in np.ndindex(height, width) if found[at] != FAR} == expected
