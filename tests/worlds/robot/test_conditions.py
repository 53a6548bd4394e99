"""Which tasks are drawn, and what is told where none can be."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.bug_trap import BugTrap
from fogbench.worlds.maps.families.maze import Maze
from fogbench.worlds.maps.families.rooms import Rooms
from fogbench.worlds.maps.families.tunnel import Tunnel
from fogbench.worlds.maps.layout import Layout
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.robot.walls import touches
from fogbench.worlds.types import MapError

Meet = Callable[..., RobotConditions]

EMPTY = np.zeros((40, 50), np.bool_)  # 4 x 5 m


@pytest.mark.parametrize(
    ("family", "walls"),
    [
        (Blobs(size=100, obstacles=(10, 20), obstacle_size=(3, 15)), {}),
        (Maze(size=11), {"cell": 1.0, "split": 10}),
        (Rooms(size=15, rooms=(2, 3), doors=(1, 2)), {"cell": 0.8, "split": 8}),
        (BugTrap(size=20, depth=(5, 8), width=(5, 7)), {"cell": 0.8, "split": 4}),
        (Tunnel(length=(8, 12)), {"cell": 0.9, "split": 9}),
    ],
    ids=lambda each: type(each).__name__,
)
def test_any_family_of_cells_makes_walls(meet: Meet, family: Any, walls: Any) -> None:
    """Start and goal have their clearance, and the optimum is between its bounds."""
    conditions = meet(walls=walls, tasks={"distance": (2, 60)})
    for seed in range(3):
        world = family.sample(np.random.default_rng(seed), seed, conditions)
        assert 2 <= world.shortest() <= 60
        assert 0.3 < world.straight() <= world.shortest()
        cell = conditions.walls.side
        for x, y in (world.start[:2], world.task.goal):
            assert not touches(world.cells, x / cell, y / cell, 0.35 / cell)


@pytest.mark.parametrize(
    ("start", "goal", "blocks"),
    [
        ((20, 4), (20, 4), {}),
        ((20, 4), (20, 6), {}),
        ((20, 2), (20, 40), {}),
        ((20, 4), (20, 40), {"tasks": {"distance": (4, 5)}}),
        ((20, 4), (20, 40), {"tasks": {"distance": (1, 3)}}),
        ((20, 4), (20, 40), {"tasks": {"clearance": 0.5}}),
        ((20, 4), (20, 40), {"body": {"radius": 0.5}}),
        ((20, 4), (20, 40), {"budget": {"steps": 7}}),
    ],
    ids=[
        "the same",
        "nearer than the goal's radius",
        "beside a wall",
        "too near",
        "too far",
        "clearance",
        "body",
        "budget",
    ],
)
def test_what_does_not_fit_is_no_task(meet: Meet, start: Any, goal: Any, blocks: Any) -> None:
    """None where a rule says so; without it, a world."""
    assert meet().world(Layout(EMPTY), (20, 4), (20, 40)) is not None
    assert meet(**blocks).world(Layout(EMPTY), start, goal) is None


def test_a_start_in_a_wall_is_no_task(meet: Meet) -> None:
    """Nor is a goal."""
    blocked = EMPTY.copy()
    blocked[20, 4] = True
    assert meet().world(Layout(blocked), (20, 4), (20, 40)) is None
    assert meet().world(Layout(blocked), (20, 40), (20, 4)) is None


def test_a_corridor_narrower_than_the_body_is_told(meet: Meet) -> None:
    """In one line, with what to change."""
    conditions = meet(walls={"cell": 0.3, "split": 3}, tasks={"distance": (2, 20), "clearance": 0.1})
    with pytest.raises(MapError) as caught:
        Maze(size=5).sample(np.random.default_rng(0), 0, conditions)
    assert str(caught.value) == (
        "Maze: no task with an optimum of 2 to 20 m (set by `tasks: {distance: ...}`), 0.1 m of clearance at both ends "
        "(set by `tasks: {clearance: ...}`) and corridors wider than a body of 0.4 m was found on 1000 maps"
    )


@pytest.mark.parametrize(
    ("blocks", "told"),
    [
        ({"walls": {"cell": 0}}, "Input should be greater than 0"),
        ({"walls": {"cell": 0.001}}, "cells of at least 0.002 m for a body of 0.2 m"),
        ({"tasks": {"distance": (5, 1)}}, "two numbers, the smaller first"),
        ({"body": {"decision": 0.03}}, "a multiple of 0.02 s"),
        ({"sensor": {"beams": 0}}, "Input should be greater than or equal to 1"),
    ],
)
def test_settings_that_make_no_sense_are_refused(meet: Meet, blocks: Any, told: str) -> None:
    """Each at its place."""
    with pytest.raises(ValidationError, match=told):
        meet(**blocks)


def test_a_sensor_shows_what_a_beam_can_meet(meet: Meet) -> None:
    """Within its range, with no wall between."""
    blocked = np.zeros((1, 12), np.bool_)
    blocked[0, 8] = True
    places = np.array([[0, 0], [0, 3], [0, 7], [0, 9]])
    conditions = meet(walls={"cell": 1.0}, sensor={"range": 6.0})
    assert conditions.shows(blocked, (0, 8), places).tolist() == [False, True, True, True]
    assert conditions.shows(blocked, (0, 11), places).tolist() == [False, False, False, True]
