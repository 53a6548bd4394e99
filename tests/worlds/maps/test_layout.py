"""From a drawn map to a world, for every family that draws its maps."""

from typing import Any

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import chisquare

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.bug_trap import BugTrap
from fogbench.worlds.maps.families.maze import Maze
from fogbench.worlds.maps.families.rooms import Rooms
from fogbench.worlds.maps.families.tunnel import Tunnel
from fogbench.worlds.maps.layout import DrawnMaps, Layout, fit
from fogbench.worlds.types import Array, MapError

FAMILIES: list[DrawnMaps] = [
    Blobs(size=16, obstacles=(0, 30), obstacle_size=(1, 4)),
    Tunnel(length=(2, 20), open=0.5),
    Tunnel(length=(16, 30), width=3, bends=(0, 3), goal="inside"),
    Maze(size=15, loops=0.2),
    Rooms(size=17, rooms=(1, 4), doors=(0, 2)),
    BugTrap(size=16, depth=(3, 8), width=(5, 9), lip=(0, 2)),
]
SEEDS = st.integers(0, 2**32 - 1)


def conditions(steps: int = 60, **blocks: Any) -> GridConditions:
    """Conditions with a step budget."""
    return GridConditions.model_validate({"budget": {"steps": steps}, **blocks})


def optimum(blocked: Array, start: tuple[int, int], goal: tuple[int, int]) -> int:
    """Length of a shortest path, by networkx."""
    graph = nx.grid_2d_graph(*blocked.shape)
    graph.remove_nodes_from(map(tuple, np.argwhere(blocked).tolist()))
    return int(nx.shortest_path_length(graph, start, goal))


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.words())
@settings(max_examples=25, deadline=None)
@given(seed=SEEDS)
def test_every_world_can_be_solved_inside_its_bounds(family: DrawnMaps, seed: int) -> None:
    """Start and goal are different free cells; the optimum is the length of a shortest path, and is in the bounds."""
    found = family.sample(np.random.default_rng(seed), 0, conditions(tasks={"distance": [4, 25]}))
    start, goal = found.start, found.task.goal
    assert not found.blocked[start]
    assert not found.blocked[goal]
    assert 4 <= found.shortest() == optimum(found.blocked, start, goal) <= 25
    assert found.task.extent == found.blocked.shape


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.words())
@settings(max_examples=10, deadline=None)
@given(seed=SEEDS, episode=st.integers(0, 5))
def test_the_generator_alone_fixes_a_world(family: DrawnMaps, seed: int, episode: int) -> None:
    """Equal generators give equal worlds, whatever the episode, and nobody can change the map."""
    first = family.sample(np.random.default_rng(seed), 0, conditions())
    again = family.sample(np.random.default_rng(seed), episode, conditions())
    assert np.array_equal(first.blocked, again.blocked)
    assert (first.start, first.task, first.posts) == (again.start, again.task, again.posts)
    assert not first.blocked.flags.writeable


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.words())
def test_drawn_maps_never_run_out(family: DrawnMaps) -> None:
    """A family that draws its maps has any number of tasks, and its words say all its settings."""
    assert family.tasks(conditions(), 1) is None
    assert family.words() == f"{type(family).__name__} {family.model_dump_json()}"


def test_pairs_are_uniform() -> None:
    """On a map of five connected cells, each of the twenty ordered pairs is drawn equally often."""
    blocked = np.array([[0, 0, 1], [0, 0, 0]], bool)
    rng = np.random.default_rng(0)
    counts: dict[Any, int] = {}
    for _ in range(4000):
        found = fit(Layout(blocked), conditions(), rng)
        assert found is not None
        counts[found.start, found.task.goal] = counts.get((found.start, found.task.goal), 0) + 1
    assert len(counts) == 20
    assert chisquare(list(counts.values())).pvalue > 0.001


@pytest.mark.parametrize("free", [0, 1])
def test_a_map_without_two_free_cells_has_no_task(free: int) -> None:
    """Nothing is drawn where start and goal cannot differ."""
    blocked = np.ones((2, 2), bool)
    blocked.flat[:free] = False
    assert fit(Layout(blocked), conditions(), np.random.default_rng(0)) is None


def test_only_tasks_inside_the_bounds_make_a_world() -> None:
    """On a detour of six cells round a wall: too near, too far, blocked, unreachable and empty tasks make none."""
    blocked = np.array([[0, 1, 0, 1], [0, 1, 0, 1], [0, 0, 0, 1], [1, 1, 1, 0]], bool)
    layout = Layout(blocked)

    def optimum_in(start: tuple[int, int], goal: tuple[int, int], **blocks: Any) -> int | None:
        found = conditions(**blocks).world(layout, start, goal)
        return None if found is None else found.optimum

    assert optimum_in((0, 0), (0, 2)) == 6
    assert optimum_in((0, 0), (0, 2), tasks={"distance": [6, 6]}) == 6
    assert optimum_in((0, 0), (0, 2), tasks={"distance": [7, 9]}) is None
    assert optimum_in((0, 0), (0, 2), tasks={"distance": [1, 5]}) is None
    assert optimum_in((0, 0), (0, 2), steps=5) is None
    assert optimum_in((0, 0), (0, 2), budget={"steps": {"per_distance": 3}}) == 6
    assert optimum_in((0, 0), (0, 2), budget={"steps": {"per_distance": 2, "plus": 1}}) is None
    assert optimum_in((0, 0), (0, 0)) is None
    assert optimum_in((0, 0), (0, 1)) is None
    assert optimum_in((0, 1), (0, 0)) is None
    assert optimum_in((0, 0), (3, 3)) is None


@pytest.mark.parametrize(
    ("blocks", "bounds"),
    [
        ({"tasks": {"distance": [500, 600]}}, "an optimum of 500 to 600 cells (set by `tasks: {distance: ...}`)"),
        ({}, "an optimum inside the step budget (set by `budget: {steps: ...}`)"),
    ],
)
def test_a_family_without_a_fitting_task_says_so(blocks: dict[str, Any], bounds: str) -> None:
    """Bounds that no map can meet end in one line that names the family and the bounds."""
    with pytest.raises(MapError) as error:
        Tunnel(length=(9, 9)).sample(np.random.default_rng(0), 0, conditions(steps=1, **blocks))
    assert str(error.value) == f"Tunnel: no task with {bounds} was found on 1000 maps"


def test_large_maps_are_given_up_sooner() -> None:
    """A search that would take an hour on the largest maps ends after some of them."""
    maps = Blobs(size=4096, obstacles=(0, 1_000_000), obstacle_size=(1, 2))
    with pytest.raises(MapError, match="was found on 4 maps"):
        maps.sample(np.random.default_rng(0), 0, conditions(steps=20_000, tasks={"distance": [12_000, 13_000]}))
