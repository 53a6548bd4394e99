"""The random walk, held against its definition and the chi-square test."""

from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.stats import chisquare

from fogbench.planners.random_walk import RandomWalk
from fogbench.worlds.grid.rules import SquareView
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.types import BLOCKED, FREE, Array, Budget, Move, Observation, Task

TASK = Task("grid", (0, 0), SquareView(radius=1), Budget(100), (3, 3))


def look(*blocked: Move) -> Observation:
    """A view of radius 1 with the given sides blocked."""
    view: Array = np.full((3, 3), FREE, np.uint8)  # [K, K]
    for move in blocked:
        view[1 + move.delta[0], 1 + move.delta[1]] = BLOCKED
    return Observation(0, (1, 1), view, blocked=False)


@pytest.mark.parametrize("blocked", [(), (Move.DOWN,), (Move.RIGHT, Move.LEFT), (Move.DOWN, Move.RIGHT, Move.UP)])
def test_open_moves_are_equally_likely(blocked: tuple[Move, ...]) -> None:
    """6000 draws are compatible with the uniform law over the moves that are seen to be open, and no other is drawn."""
    walker = RandomWalk().start(TASK, np.random.default_rng(1))
    counts = Counter(walker.act(look(*blocked)) for _ in range(6000))
    assert set(counts) == set(Move) - set(blocked)
    assert chisquare(list(counts.values())).pvalue > 0.01 or len(counts) == 1


def test_the_walk_gives_up_where_it_is_walled_in() -> None:
    """With all four sides blocked there is no move."""
    assert RandomWalk().start(TASK, np.random.default_rng(0)).act(look(*Move)) is None


def test_the_walk_never_collides(strew: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """In 20 noise-free worlds no step enters an obstacle, and the walk holds and searches nothing."""
    for seed in range(20):
        rng = np.random.default_rng(seed)
        world = strew(rng, steps=200)
        for moment in explore(RandomWalk(), world, rng):
            assert moment.step is not None
            assert not moment.step.collided
            assert (moment.agent.memory_bytes(), moment.agent.search_nodes()) == (0, 0)


def test_a_blocked_side_does_not_shift_the_luck() -> None:
    """One number is drawn at every decision, even where there is no choice."""
    first, second = (RandomWalk().start(TASK, np.random.default_rng(7)) for _ in range(2))
    first.act(look())
    second.act(look(*Move))
    assert [first.act(look()) for _ in range(50)] == [second.act(look()) for _ in range(50)]
