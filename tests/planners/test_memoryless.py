"""What a planner without memory does, by hand."""

from collections.abc import Callable
from typing import Any

import numpy as np

from fogbench.planners.astar import AStar
from fogbench.planners.memoryless import Memoryless
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.types import Move

WALL = """
    ..#.
    ..#.
    .S#G
    ..#.
    ..#.
    ....
"""


def test_without_memory_it_paces_before_a_wall(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """At radius 1 it goes down past the wall, forgets the upper part, goes up again, and so on for ever."""
    moments = list(explore(Memoryless(), draw(WALL, steps=12), np.random.default_rng(0)))
    assert [moment.action for moment in moments] == [Move.DOWN, Move.UP] * 6


def test_with_memory_it_walks_round(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """The same search with a known map gets there, after the 4 steps spent on looking at the upper part."""
    *_, last = explore(AStar(), draw(WALL, steps=12), np.random.default_rng(0))
    assert last.step.reached


def test_nothing_is_held_and_every_search_counts(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """On an empty corridor of 4 cells the searches expand 4, 3 and 2 cells, and no byte is held."""
    moments = explore(Memoryless(), draw("S..G"), np.random.default_rng(0))
    seen = [(moment.agent.search_nodes(), moment.agent.memory_bytes()) for moment in moments]
    assert seen == [(4, 0), (7, 0), (9, 0)]


def test_it_gives_up_where_the_view_leaves_no_path(misled: Callable[..., Any]) -> None:
    """With the goal read as blocked there is no path; with the goal out of view there is."""
    actions, _ = misled(Memoryless())
    assert actions == [None, Move.RIGHT]
