"""Maps that grow from easy to full."""

import numpy as np
import pytest

from fogbench.learned.training.curriculum import eased, farther
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.maze import Maze
from fogbench.worlds.maps.families.rooms import Rooms
from fogbench.worlds.maps.families.tunnel import Tunnel
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.types import MapFamily

EASY = Blobs(size=32, obstacles=(2, 2), obstacle_size=(1, 2))
FULL = Blobs(size=32, obstacles=(0, 30), obstacle_size=(1, 5))


def test_numbers_grow_in_step() -> None:
    """At the ends stand the two families; in between each number is as far on its way, rounded."""
    assert eased(EASY, FULL, 0) == EASY
    assert eased(EASY, FULL, 0.5) == Blobs(size=32, obstacles=(1, 16), obstacle_size=(1, 4))
    assert eased(EASY, FULL, 1) is FULL


def test_words_change_at_the_end() -> None:
    """What is no number stays easy until the full family; fractions grow without being rounded."""
    easy, full = Tunnel(length=(4, 4), goal="inside"), Tunnel(length=(4, 20), open=0.5)
    assert eased(easy, full, 0.5) == Tunnel(length=(4, 12), open=0.25, goal="inside")
    assert eased(easy, full, 1) == full


def test_a_maze_grows_by_odd_sizes() -> None:
    """What lies in between as a number but is no maze is left out."""
    sizes = [eased(Maze(size=5), Maze(size=9), share) for share in (0, 0.25, 0.45, 0.55, 0.75, 1)]
    assert sizes == [Maze(size=size) for size in (5, 5, 7, 7, 7, 9)]


@pytest.mark.parametrize(
    ("easy", "full"),
    [
        (Tunnel(length=(4, 4)), Tunnel(length=(9, 9), width=3)),
        (Tunnel(length=(4, 10)), Tunnel(length=(8, 20), bends=(1, 3))),
        (Rooms(size=5, rooms=(2, 2), doors=(1, 1)), Rooms(size=15, rooms=(8, 8), doors=(1, 1))),
        (Maze(size=15), Maze(size=5)),
    ],
)
def test_all_on_the_way_is_valid(easy: MapFamily, full: MapFamily) -> None:
    """Whatever stands at its ends, a training never meets a family that cannot be."""
    assert all(isinstance(eased(easy, full, share), type(full)) for share in np.linspace(0, 1, 501))


@pytest.mark.parametrize("kind", [GridConditions, GraphConditions])
def test_goals_move_away_in_step(kind: type[GridConditions | GraphConditions]) -> None:
    """Bounds of the optimum grow like any numbers; nothing else of the conditions changes."""
    block = {"tasks": {"distance": [3, 21]}, "budget": {"steps": 30}, "rules": {"slip": 0.1}}
    own = kind.model_validate(block)
    for share, distance in ((0, (1, 2)), (0.5, (2, 12)), (1, (3, 21))):
        assert farther((1, 2), own, share) == kind.model_validate({**block, "tasks": {"distance": distance}})


def test_goals_move_away_in_metres() -> None:
    """Bounds that are no whole numbers grow from whole ones, and are not rounded."""
    block = {"tasks": {"distance": [8, 59]}, "budget": {"steps": 90}}
    own = RobotConditions.model_validate(block)
    half = RobotConditions.model_validate({**block, "tasks": {"distance": [5, 32]}})
    assert farther((2, 5), own, 0.5) == half
    assert farther((2, 5), own, 1) == own


def test_goals_move_away_to_bounds_alone() -> None:
    """Without them nobody knows where they should end."""
    with pytest.raises(Mistake) as error:
        farther((1, 2), GridConditions.model_validate({"budget": {"steps": 30}}), 0.5)
    assert str(error.value) == "got a curriculum over distance; expected `tasks: {distance: ...}`, where it ends"
