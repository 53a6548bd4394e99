"""How paths are driven: no touch, whatever the path; room is made where none is left."""

from math import dist

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fogbench.planners.robot.pilot import PATIENCE, Pilot, in_sight, safe
from fogbench.worlds.robot.driving import aim
from fogbench.worlds.robot.rules import Body, Lidar, Outfit
from fogbench.worlds.robot.unicycle import drive
from fogbench.worlds.robot.walls import clearance
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN

OUTFIT = Outfit(Lidar(), Body(), 0.1, 0.3)
BODY = OUTFIT.body
HALL = np.full((60, 60), FREE, np.uint8)  # 6 x 6 m
LINE = np.stack([np.linspace(1, 5, 41), np.full(41, 3.0)], -1)


def test_an_open_path_is_driven_as_fast_as_can_be() -> None:
    """The waypoint is as far away as a waypoint may be, on the line, with its heading."""
    waypoint = Pilot(OUTFIT).waypoint(HALL, (1.0, 3.0, 0.0), LINE)
    assert np.allclose(waypoint, (2.0, 3.0, 0.0))


def test_a_wall_on_the_path_is_kept_away_from() -> None:
    """The robot stops before it, and turns to the path where it stands."""
    cells = HALL.copy()
    cells[:, 30] = BLOCKED
    pilot, pose, v, w = Pilot(OUTFIT), (1.0, 3.0, 0.0), 0.0, 0.0
    for _ in range(12):
        waypoint = aim(tuple(pilot.waypoint(cells, pose, LINE)), pose, pose, BODY.stride)
        pose, v, w, _, touched, _ = drive(cells, 0.1, 0.2, pose, v, w, waypoint, BODY.limits, BODY.ticks, (0, 0), -1.0)
        assert not touched
        assert (pilot.v, pilot.w) == (v, w)
    assert pose[0] > 2


@settings(max_examples=40)
@given(seed=st.integers(0, 2**32 - 1))
def test_no_path_leads_into_a_known_wall(seed: int) -> None:
    """Random points between random walls, unknown counted as free: the unicycle never touches one."""
    rng = np.random.default_rng(seed)
    cells = np.where(rng.random((60, 60)) < 0.01, BLOCKED, rng.integers(UNKNOWN, BLOCKED, (60, 60))).astype(np.uint8)
    pilot, v, w = Pilot(OUTFIT), 0.0, 0.0
    pose = (*rng.uniform(1, 5, 2).tolist(), 0.0)
    if clearance(cells, pose[0] / 0.1, pose[1] / 0.1, 2.2) < 2.2:
        return
    for _ in range(15):
        path = np.cumsum(rng.uniform(-0.4, 0.4, (12, 2)), 0) + pose[:2]
        waypoint = aim(tuple(pilot.waypoint(cells, pose, path)), pose, pose, BODY.stride)
        pose, v, w, _, touched, _ = drive(cells, 0.1, 0.2, pose, v, w, waypoint, BODY.limits, BODY.ticks, (0, 0), -1.0)
        assert not touched


def test_room_is_made_where_the_robot_stays() -> None:
    """In a corner with no way out along the path, it drives to where the walls are farther, by and by."""
    cells = HALL.copy()
    cells[:, 8] = BLOCKED  # 0.8 m from the left
    pilot, pose = Pilot(OUTFIT), (0.4, 0.45, 0.0)
    path = np.stack([np.linspace(0.4, 3, 27), np.full(27, 0.45)], -1)
    for _ in range(PATIENCE + 1):
        assert dist(pilot.waypoint(cells, pose, path)[:2], pose[:2]) < 0.2
    waypoint = pilot.waypoint(cells, pose, path)
    assert dist(waypoint[:2], pose[:2]) > 0.15
    assert waypoint.y > pose[1]


def test_a_wish_is_driven_to_if_it_is_safe() -> None:
    """Otherwise the path is."""
    cells = HALL.copy()
    cells[26, :] = BLOCKED
    assert np.allclose(Pilot(OUTFIT).waypoint(cells, (1.0, 3.0, 0.0), LINE, (1.5, 3.5, 0.3)), (1.5, 3.5, 0.3))
    refused = Pilot(OUTFIT).waypoint(cells, (1.0, 3.0, -1.57), LINE, (1.0, 2.4, 0.0))
    assert np.allclose(refused, (2.0, 3.0, 0.0))


def test_what_is_in_sight_and_safe() -> None:
    """A disc that fits beside a wall is in sight of what is behind it, one that does not is not."""
    cells = HALL.copy()
    cells[28, 30] = BLOCKED  # its upper side 0.1 m below the line
    pose = (2.0, 3.0, 0.0)
    assert in_sight(cells, 0.1, 0.09, pose, 4.0, 3.0)
    assert not in_sight(cells, 0.1, 0.2, pose, 4.0, 3.0)
    assert safe(cells, 0.1, 0.2, pose, 0.0, 0.0, (2.5, 3.0, 0.0), BODY.limits, BODY.ticks)
    assert not safe(cells, 0.1, 0.2, pose, 1.0, 0.0, (4.0, 3.0, 0.0), BODY.limits, 2 * BODY.ticks)
