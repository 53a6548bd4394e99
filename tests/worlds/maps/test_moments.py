"""The marked moments of an episode in a tunnel."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fogbench.worlds.maps.families.tunnel import Tunnel
from fogbench.worlds.maps.moments import corridor
from fogbench.worlds.types import Cell

TUNNEL = """
    ..........
    ..........
    ..######..
    ...S.PP#G.
    ..######..
    ..........
    ..........
"""
"""Five cells to an end wall that is in view from the last two."""

COLUMNS = [3, 4, 5, 6, 5, 4, 3, 2, 1, 0]
"""Of a way to the end wall and out again."""


@pytest.mark.parametrize(
    ("columns", "marks"),
    [
        (COLUMNS, {"end wall in view": 2, "turn": 3, "exit": 8}),
        (COLUMNS[:9], {"end wall in view": 2, "turn": 3}),
        ([3, 4, 5, 5, 5, 6, 6, 5, 5], {"end wall in view": 2, "turn": 6}),
        ([3, 2, 1, 0, 1, 2], {"exit": 2}),
        ([3, 3], {}),
        ([3], {}),
    ],
    ids=["all", "the last cell has no decision", "slips are no turns", "a turn outside", "stuck", "no decision"],
)
def test_marks_of_a_hand_built_tunnel(columns: list[int], marks: dict[str, int], draw: Callable[..., Any]) -> None:
    """Each is the number of the first such decision; what never happens is left out."""
    path: list[Cell] = [(3, column) for column in columns]
    world = draw(TUNNEL)
    assert Tunnel(length=(5, 5)).moments(world, path) == marks


@pytest.mark.parametrize("width", [1, 3])
@pytest.mark.parametrize("open_", [0.0, 1.0], ids=["closed", "open"])
def test_a_corridor_has_as_many_cells_as_the_tunnel_is_long_and_wide(
    width: Any, open_: float, conditions: Callable[..., Any]
) -> None:
    """An open end adds its gap; the start is always in it."""
    family = Tunnel(length=(6, 30), width=width, open=open_)
    for episode in range(50):
        rng = np.random.default_rng(episode)
        layout = family.draw(rng, conditions())
        length = int(np.random.default_rng(episode).integers(6, 30, endpoint=True))  # the first number drawn
        inside = corridor(layout.blocked, width)
        assert inside.sum() == width * (length + (open_ == 1))
        assert inside[layout.start]
        assert all(inside[post] for post in layout.posts)


def test_bends_belong_to_the_corridor(conditions: Callable[..., Any]) -> None:
    """Starts and posts are in it, and the goal behind the end wall is not."""
    family = Tunnel(length=(20, 40), bends=(1, 1))
    for episode in range(50):
        layout = family.draw(np.random.default_rng(episode), conditions())
        inside = corridor(layout.blocked, 1)
        assert all(inside[cell] for cell in (layout.start, *layout.posts))
        assert not inside[layout.goal]
