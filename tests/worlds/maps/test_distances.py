"""Distances, held against networkx."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fogbench.worlds.maps.distances import FAR, distance, distances
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


@given(maps, st.data())
def test_a_distance_is_that_of_networkx(blocked: Array, data: st.DataObject) -> None:
    """Between any two cells the search finds the shortest distance, or FAR where that is above the limit."""
    cells = st.tuples(*(st.integers(0, side - 1) for side in blocked.shape))
    source, target = data.draw(cells), data.draw(cells)
    most = data.draw(st.integers(0, 30))
    blocked[target] = False
    exact = int(independent(blocked, source)[target])
    assert distance(blocked, source, target, most) == (exact if exact <= most else FAR)


@pytest.mark.parametrize("seed", range(20))
def test_a_distance_is_that_of_a_plain_search(seed: int) -> None:
    """On larger maps with many detours, A* and the breadth-first search agree."""
    rng = np.random.default_rng(seed)
    blocked = rng.random((60, 80)) < rng.uniform(0.1, 0.45)
    free = np.argwhere(~blocked)
    for a, b in rng.choice(free, size=(30, 2)).tolist():
        assert distance(blocked, tuple(a), tuple(b), FAR) == distances(blocked, tuple(a), tuple(b))[tuple(b)]
