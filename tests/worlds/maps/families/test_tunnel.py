"""Tunnels."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.ndimage import label
from scipy.stats import binomtest, chisquare

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.cells import manhattan
from fogbench.worlds.maps.families.tunnel import Tunnel
from fogbench.worlds.maps.layout import Layout
from fogbench.worlds.types import Array, Cell

STRAIGHT = """
..........
..........
...#####..
....ooo#G.
...#####..
..........
..........
"""
BENT = """
........
........
...###..
....o#..
...#o#..
...#o#..
...###..
....G...
........
"""
WIDE_OPEN = """
............
............
....#####...
............
.........G..
............
....#####...
............
............
"""
INSIDE = STRAIGHT.replace("#G", "#.").replace("ooo#", "ooG#")


def conditions(radius: int = 3, occlusion: bool = True) -> GridConditions:
    """Conditions with a sensor."""
    sensor = {"radius": radius, "occlusion": occlusion}
    return GridConditions.model_validate({"budget": {"steps": 10000}, "sensor": sensor})


def draw(seed: int, under: GridConditions | None = None, **fields: Any) -> Layout:
    """A tunnel."""
    return Tunnel.model_validate(fields).draw(np.random.default_rng(seed), under or conditions())


def picture(layout: Layout) -> str:
    """The map with its posts `o` and its goal `G`, as text."""
    letters = np.where(layout.blocked, "#", ".")
    for post in layout.posts:
        letters[post] = "o"
    assert layout.goal is not None
    letters[layout.goal] = "G"
    return text(letters)


def text(letters: Array) -> str:
    """Rows of letters, one a line."""
    return "\n".join(map("".join, letters.tolist()))


def symmetries(drawing: str) -> set[str]:
    """The eight rotations and reflections of a drawing; fewer if some are equal."""
    letters = np.array([list(row) for row in drawing.split()])
    return {text(np.rot90(side, k)) for side in (letters, letters.T) for k in range(4)}


@pytest.mark.parametrize(
    ("drawing", "fields"),
    [
        (STRAIGHT, {"length": (4, 4)}),
        (INSIDE, {"length": (4, 4), "goal": "inside"}),
        (BENT, {"length": (4, 4), "bends": (1, 1)}),
        (WIDE_OPEN, {"length": (4, 4), "width": 3, "open": 1}),
    ],
)
def test_tunnels_look_as_drawn_by_hand_in_every_orientation(drawing: str, fields: dict[str, Any]) -> None:
    """Walls, margin, goal and posts are those of a drawing by hand, and each of its symmetries is drawn."""
    assert {picture(draw(seed, **fields)) for seed in range(100)} == symmetries(drawing)


@pytest.mark.parametrize(
    ("radius", "occlusion", "posts"),
    [
        (1, True, {(5, 4)}),
        (2, False, {(5, 4), (4, 4)}),
        (3, True, {(5, 4), (4, 4), (3, 4)}),
        (3, False, {(5, 4), (4, 4), (3, 4), (3, 3)}),
    ],
)
def test_posts_are_where_the_end_wall_is_in_view(radius: int, occlusion: bool, posts: set[Cell]) -> None:
    """In the bent tunnel, radius and occlusion decide which of its four cells show the end wall."""
    layouts = (draw(seed, conditions(radius, occlusion), length=(4, 4), bends=(1, 1)) for seed in range(100))
    upright = np.array([[letter == "#" for letter in row] for row in BENT.split()])
    assert {layout.posts for layout in layouts if np.array_equal(layout.blocked, upright)} == {frozenset(posts)}


def plugs(blocked: Array, width: int) -> Iterator[tuple[Array, Array]]:
    """Rows and columns of every straight line of `width` free cells with a blocked cell at either end."""
    cells: Array = np.indices(blocked.shape)  # [2, H, W]
    for lines in (cells, cells.swapaxes(1, 2)):
        for rows, columns in lines.swapaxes(0, 1):
            for a, b in pairwise(np.flatnonzero(blocked[rows, columns])):
                if b - a == width + 1:
                    yield rows[a + 1 : b], columns[a + 1 : b]


def corridor(blocked: Array, goal: Cell, width: int) -> Array:
    """The most that one plug across a corridor cuts off from the goal, with the plug's cells: [H, W] bool."""
    most = np.zeros_like(blocked)
    for plug in plugs(blocked, width):
        closed = blocked.copy()
        closed[plug] = True
        names, count = label(~closed)
        if count == 2 and not closed[goal]:
            most = max(most, ~blocked & (names != names[goal]), key=np.sum)
    return most


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), width=st.sampled_from([1, 3]), bends=st.integers(0, 4), spare=st.integers(0, 12))
def test_a_closed_tunnel_can_be_left_by_its_mouth_alone(seed: int, width: int, bends: int, spare: int) -> None:
    """All free cells are connected, and a line of cells across the mouth cuts off `width` times the length."""
    length = (bends + 1) * (width + 1) + spare
    layout = draw(seed, length=(length, length), width=width, bends=(bends, bends))
    assert layout.start is not None
    assert layout.goal is not None
    assert label(~layout.blocked)[1] == 1
    inside = corridor(layout.blocked, layout.goal, width)
    assert inside.sum() == width * length
    assert inside[layout.start]


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), bends=st.integers(0, 5), spare=st.integers(0, 12))
def test_bends_are_quarter_turns_of_one_simple_path(seed: int, bends: int, spare: int) -> None:
    """A narrow corridor is a path that touches itself nowhere and turns `bends` times."""
    length = 2 * (bends + 1) + spare
    layout = draw(seed, length=(length, length), bends=(bends, bends))
    assert layout.goal is not None
    graph = nx.grid_2d_graph(*layout.blocked.shape)
    graph.remove_nodes_from(map(tuple, np.argwhere(~corridor(layout.blocked, layout.goal, 1)).tolist()))
    assert nx.is_tree(graph)
    path = np.array(nx.shortest_path(graph, *nx.periphery(graph)))  # [length, 2]
    assert len(path) == len(graph) == length
    assert np.count_nonzero(np.diff(path, 2, axis=0).any(1)) == bends


def test_the_start_is_uniform_over_the_corridor() -> None:
    """In a tunnel of five cells, each is the start equally often; they differ in their distance to the goal."""
    family, rng, under = Tunnel(length=(5, 5)), np.random.default_rng(0), conditions()
    counts = np.unique([family.sample(rng, 0, under).optimum for _ in range(1500)], return_counts=True)[1]
    assert len(counts) == 5
    assert chisquare(counts).pvalue > 0.001


def test_a_goal_inside_is_never_the_start() -> None:
    """With the goal on the last of two cells, the start is the cell beside it."""
    for seed in range(50):
        layout = draw(seed, length=(2, 2), goal="inside")
        assert layout.start is not None
        assert layout.goal is not None
        assert manhattan(layout.start, layout.goal) == 1


def test_lengths_and_open_ends_are_drawn_as_asked() -> None:
    """Lengths are uniform in their range, and the share of open tunnels, which have no posts, is `open`."""
    layouts = [draw(seed, length=(3, 6), open=0.3) for seed in range(1200)]
    lengths = np.array([max(layout.blocked.shape) - 6 for layout in layouts])
    assert chisquare(np.bincount(lengths)[3:]).pvalue > 0.001
    assert binomtest(sum(not layout.posts for layout in layouts), 1200, 0.3).pvalue > 0.001


def test_an_open_tunnel_leads_straight_to_its_goal() -> None:
    """Without an end wall the optimum is the straight distance."""
    rng = np.random.default_rng(0)
    for _ in range(20):
        found = Tunnel(length=(4, 9), width=3, open=1).sample(rng, 0, conditions())
        assert found.shortest() == found.straight()
        assert found.posts == frozenset()


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"length": (1, 5)}, "a length from 2, for 0 bends and width 1"),
        ({"length": (15, 20), "width": 3, "bends": (0, 3)}, "a length from 16, for 3 bends and width 3"),
    ],
)
def test_a_tunnel_too_short_for_its_bends_is_refused(fields: dict[str, Any], text: str) -> None:
    """The error says the least length that would do."""
    with pytest.raises(ValidationError) as error:
        Tunnel.model_validate(fields)
    assert [mistake["msg"] for mistake in error.value.errors()] == [f"Value error, {text}"]
