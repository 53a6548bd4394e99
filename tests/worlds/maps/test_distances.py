"""Breadth-first distances, held against networkx."""

import networkx as nx
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fogbench.worlds.maps.distances import FAR, distances
from fogbench.worlds.types import Array

maps = st.tuples(st.integers(1, 8), st.integers(1, 8)).flatmap(lambda shape: arrays(np.bool_, shape))


def independent(blocked: Array, source: tuple[int, int]) -> Array:
    """Distances by networkx, FAR where there is no path; the source is open."""
    graph = nx.grid_2d_graph(*blocked.shape)
    graph.remove_nodes_from([cell for cell in map(tuple, np.argwhere(blocked).tolist()) if cell != source])
    found = np.full(blocked.shape, FAR, np.int32)
    for cell, length in nx.single_source_shortest_path_length(graph, source).items():
        found[cell] = length
    return found


@given(maps, st.data())
def test_distances_are_those_of_networkx(blocked: Array, data: st.DataObject) -> None:
    """Without a target every cell has its shortest distance, and FAR means that there is no path."""
    source = data.draw(st.tuples(*(st.integers(0, side - 1) for side in blocked.shape)))
    found = distances(blocked, source, (-1, -1))
    assert found.dtype == np.int32
    assert np.array_equal(found, independent(blocked, source))


@given(maps, st.data())
def test_an_early_stop_keeps_its_promise(blocked: Array, data: st.DataObject) -> None:
    """All cells up to the target's distance are exact, the others exact or FAR; out of reach it stops nothing."""
    cells = st.tuples(*(st.integers(0, side - 1) for side in blocked.shape))
    source, target = data.draw(cells), data.draw(cells)
    found, exact = distances(blocked, source, target), independent(blocked, source)
    near = exact <= exact[target]
    assert np.array_equal(found[near], exact[near])
    assert np.all((found == exact) | (found == FAR))


def test_an_early_stop_does_stop() -> None:
    """In a corridor nothing beyond the target's next cell is looked at."""
    assert distances(np.zeros((1, 6), np.bool_), (0, 0), (0, 2)).tolist() == [[0, 1, 2, FAR, FAR, FAR]]
