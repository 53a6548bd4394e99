"""Value iteration on a graph, its fixed point in one pass: held against iterations of the equation, and networkx."""

from typing import Any

import networkx as nx
import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from torch import Tensor

from fogbench.learned.value_iteration.explored import ends_of
from fogbench.worlds.graph.known import NONE, KnownGraph
from fogbench.worlds.types import Array, Observation


def known_of(size: int, edges: list[tuple[int, int, float]]) -> KnownGraph:
    """What an agent knows that was at every node of a graph."""
    view = np.full((size, size, 1), np.inf)
    for a, b, length in edges:
        view[a, b] = view[b, a] = length
    known = KnownGraph((size,))
    for node in range(size):
        known.update(Observation(node, node, view[node], blocked=False))
    return known


def plain(size: int, edges: list[tuple[int, int, float]], prices: Tensor, step: Tensor) -> Tensor:
    """-log V of each node [N], as often as it takes: the least of its price and of what its neighbours cost."""
    costs = prices
    for _ in range(size):
        least = [[costs[node]] for node in range(size)]
        for a, b, length in edges:
            least[a].append(prices.new_tensor(length) * step + costs[b])
            least[b].append(prices.new_tensor(length) * step + costs[a])
        costs = torch.minimum(prices, torch.stack([torch.stack(each).min() for each in least]))
    return costs


@st.composite
def graphs(draw: st.DrawFn) -> tuple[int, list[tuple[int, int, float]], Array, float]:
    """A graph, connected or not, with prices at some nodes, and a step."""
    size = draw(st.integers(2, 9))
    pairs = [(a, b) for a in range(size) for b in range(a)]
    chosen = draw(st.lists(st.sampled_from(pairs), unique=True, max_size=14))
    luck = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    prices = np.where(luck.random(size) < 0.5, luck.random(size) * 3, np.inf)
    return size, [(a, b, float(luck.random() + 0.1)) for a, b in chosen], prices, float(luck.random())


def values(graphs: list[KnownGraph], prices: Array, step: float) -> tuple[Array, Array]:
    """The ends and distances of some graphs, one after the other."""
    nodes = np.cumsum([0, *(len(graph.heads) for graph in graphs)])
    links = np.cumsum([0, *(graph.used for graph in graphs)])
    parts: list[list[Any]] = [
        [graph.heads for graph in graphs],
        [graph.links[: graph.used] for graph in graphs],
        [graph.lengths[: graph.used] for graph in graphs],
    ]
    heads, following, lengths = (np.concatenate(part) for part in parts)
    return ends_of(nodes, links, heads, following, lengths, prices, step)


@settings(max_examples=200, deadline=None)
@given(graphs())
def test_it_is_the_fixed_point(made: Any) -> None:
    """Values, and their gradients for prices and the step, are those of iterations."""
    size, edges, told, cost = made
    prices = torch.tensor(told, dtype=torch.float64, requires_grad=True)
    step = torch.tensor(cost, dtype=torch.float64, requires_grad=True)
    expected = plain(size, edges, prices, step)
    ends, distances = values([known_of(size, edges)], told, cost)
    reached = torch.from_numpy(ends) >= 0
    assert torch.equal(reached, expected.isfinite())
    found = prices[torch.from_numpy(ends)][reached] + step * torch.from_numpy(distances)[reached]
    assert torch.allclose(found, expected[reached], atol=1e-9)
    if reached.any():
        for mine, theirs in zip(
            torch.autograd.grad(found.sum(), (prices, step), allow_unused=True, materialize_grads=True),
            torch.autograd.grad(expected[reached].sum(), (prices, step), allow_unused=True, materialize_grads=True),
            strict=True,
        ):
            assert torch.allclose(mine, theirs, atol=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_graphs_side_by_side_are_apart(seed: int) -> None:
    """The end of a node is the nearest of its own graph, as networkx finds it, whatever else is beside it."""
    luck = np.random.default_rng(seed)
    drawn = [nx.gnm_random_graph(12, 16, seed=10 * seed + number) for number in range(3)]
    marked = [set(luck.choice(12, 3, replace=False).tolist()) for _ in drawn]
    prices = np.full(36, np.inf)
    prices[[12 * number + node for number, nodes in enumerate(marked) for node in nodes]] = 0
    ends, distances = values([known_of(12, [(a, b, 1.0) for a, b in graph.edges]) for graph in drawn], prices, 1.0)
    for number, graph in enumerate(drawn):
        nearest = nx.multi_source_dijkstra_path_length(graph, marked[number])
        for node in range(12):
            end = int(ends[12 * number + node])
            assert (end == NONE) == (node not in nearest)
            assert end == NONE or end - 12 * number in marked[number]
            assert distances[12 * number + node] == nearest.get(node, 0)
