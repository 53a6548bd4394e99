"""Mazes."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.stats import binomtest

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.maze import Maze
from fogbench.worlds.types import Array

CONDITIONS = GridConditions.model_validate({"budget": {"steps": 60}})
SEEDS = st.integers(0, 2**32 - 1)


def draw(seed: int, size: int, loops: float) -> Array:
    """A maze."""
    return Maze(size=size, loops=loops).draw(np.random.default_rng(seed), CONDITIONS).blocked


@given(seed=SEEDS, cells=st.integers(2, 12))
def test_a_perfect_maze_is_a_spanning_tree(seed: int, cells: int) -> None:
    """Without loops the free cells form a tree that holds every cell on even rows and columns."""
    blocked = draw(seed, 2 * cells - 1, 0)
    graph = nx.grid_2d_graph(*blocked.shape)
    graph.remove_nodes_from(map(tuple, np.argwhere(blocked).tolist()))
    assert nx.is_tree(graph)
    assert len(graph) == cells**2 + (cells**2 - 1)  # the cells, and an opened wall for each edge of the tree
    assert not blocked[::2, ::2].any()
    assert blocked[1::2, 1::2].all()


@given(seed=SEEDS, cells=st.integers(2, 12))
def test_with_all_loops_no_wall_between_cells_is_left(seed: int, cells: int) -> None:
    """With `loops: 1` only the pillars stand."""
    blocked = draw(seed, 2 * cells - 1, 1)
    assert blocked[1::2, 1::2].all()
    assert blocked.sum() == (cells - 1) ** 2


def test_loops_is_the_share_of_standing_walls_that_are_opened() -> None:
    """Over many mazes, the opened share of the walls that a spanning tree leaves is `loops`."""
    cells, mazes = 11, 100
    standing = mazes * (2 * cells * (cells - 1) - (cells**2 - 1))
    free = sum(int((~draw(seed, 2 * cells - 1, 0.3)).sum()) for seed in range(mazes))
    assert binomtest(free - mazes * (2 * cells**2 - 1), standing, 0.3).pvalue > 0.001


def test_every_tree_of_the_smallest_maze_is_drawn() -> None:
    """Four cells in a ring have four spanning trees, each with one of the four walls standing."""
    standing = {tuple(np.argwhere(draw(seed, 3, 0)).ravel().tolist()) for seed in range(100)}
    assert standing == {(0, 1, 1, 1), (1, 0, 1, 1), (1, 1, 1, 2), (1, 1, 2, 1)}


def test_even_sizes_are_refused() -> None:
    """The error says what is expected."""
    with pytest.raises(ValidationError) as error:
        Maze(size=16)
    assert [mistake["msg"] for mistake in error.value.errors()] == ["Value error, an odd number"]
