"""The robot world, decision by decision."""

import pickle
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from math import dist, hypot, inf
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fogbench
from fogbench.worlds.picture import Cells, Dots, Lines
from fogbench.worlds.robot.world import RobotState, RobotWorld, UnicycleWorld, simulation
from fogbench.worlds.types import BLOCKED, Step, Waypoint

Draw = Callable[..., RobotWorld]

HALL = """
    .......
    .S...G.
    .......
"""

WALL = """
    ......
    .S#.G.
    ......
"""

PHYSICS = pytest.mark.parametrize("physics", ["mujoco", "unicycle"])


def walk(world: RobotWorld, *waypoints: tuple[float, float, float]) -> list[Step]:
    """What each decision did."""
    state, steps = world.reset(), []
    for waypoint in waypoints:
        steps.append(world.step(state, Waypoint(*waypoint), np.random.default_rng(0)))
        state = steps[-1].state
    return steps


@PHYSICS
def test_an_episode_to_the_goal(draw: Draw, physics: str) -> None:
    """From a start that faces the goal, straight on; the decision that comes near enough ends there."""
    world = draw(HALL, rules={"physics": physics})
    assert (world.start, world.task.goal, world.task.extent) == ((1.5, 1.5, 0.0), (5.5, 1.5), (7.0, 3.0))
    steps = walk(world, *[(5.5, 1.5, 0.0)] * 12)
    reached = [step.reached for step in steps].index(True)
    assert reached == 7
    assert not any(step.collided or step.state.blocked for step in steps)
    assert sum(step.length for step in steps[: reached + 1]) == pytest.approx(3.7, abs=0.03)
    assert dist(steps[reached].state.place[:2], world.task.goal) == pytest.approx(0.3, abs=0.021)


@PHYSICS
def test_a_wall_ends_it_or_holds_it_up(draw: Draw, physics: str) -> None:
    """A touch is a collision by the one rule, and is only told by the other; the disc stays before the wall."""
    for collision in ("fails", "blocked"):
        world = draw(WALL, rules={"physics": physics, "collision": collision})
        steps = walk(world, *[(2.5, 1.5, 0.0)] * 4)
        assert [step.state.blocked for step in steps[:2]] == [False, True]
        assert [step.collided for step in steps[:2]] == [False, collision == "fails"]
        assert steps[-1].state.place[0] == pytest.approx(1.8, abs=0.03)
        assert steps[-1].state.place[0] < 1.85


def test_a_decision_takes_as_long_as_is_asked_for(draw: Draw) -> None:
    """Ten a second drive a fifth of what two a second do."""
    states = [
        walk(draw(HALL, body={"decision": s}), *[(5.5, 1.5, 0.0)] * n)[-1].state for s, n in ((0.5, 2), (0.1, 10))
    ]
    assert states[0].place == pytest.approx(states[1].place, abs=1e-3)


def test_lengths_are_those_of_octile_paths(draw: Draw) -> None:
    """In a hall the straight line; around a wall what leaves room for the body."""
    assert draw(HALL).shortest() == pytest.approx(4)
    around = draw(WALL)
    assert around.straight() == 3
    exact = 2 * hypot(0.5, 0.7) + 2  # around two corners of the inflated block
    assert exact * 0.97 < around.shortest() < exact * 1.0824
    assert around.remaining(around.reset()) == around.shortest()
    assert set(around.covariates()) == {"density", "detour", "dead_ends", "openness"}


def test_what_remains_beside_a_wall_is_told_from_the_nearest_room(draw: Draw) -> None:
    """A cell without room for the body has no path; far inside of a wall nothing is near."""
    world = draw(WALL)
    at = RobotState(0, (1.85, 1.5, 0.0), (0.0, 0.0, 0.0), 0.0, 0.0, None, blocked=True)
    assert world.shortest() - 0.5 < world.remaining(at) < world.shortest() + 0.5
    assert world.remaining(at._replace(place=(2.5, 1.5, 0.0))) == inf


def test_a_restored_state_goes_on_bit_for_bit(draw: Draw) -> None:
    """In another model of the same world, whatever was simulated there before."""
    world = draw(WALL, rules={"collision": "blocked"})
    other = replace(world)
    waypoints = [Waypoint(1.5 + 0.3 * k, 1.5 - 0.2 * k, 0.1 * k) for k in range(6)]
    states = [step.state for step in walk(world, *waypoints)]
    walk(other, (1.0, 1.0, 0.0))
    again = [step.state for step in _after(other, pickle.loads(pickle.dumps(states[2])), waypoints[3:])]
    assert simulation(world) is not simulation(other)
    for one, two in zip(states[3:], again, strict=True):
        assert one._replace(physics=None) == two._replace(physics=None)
        assert one.physics.tobytes() == two.physics.tobytes()


def _after(world: RobotWorld, state: RobotState, waypoints: list[Waypoint]) -> list[Step]:
    steps = []
    for waypoint in waypoints:
        steps.append(world.step(state, waypoint, np.random.default_rng(0)))
        state = steps[-1].state
    return steps


PROCESS = """
import sys
sys.path.insert(0, sys.argv[1])
from hashlib import sha256
from conftest import conditions_of, strewn
import numpy as np
from fogbench.worlds.maps.layout import Layout, fit
from fogbench.worlds.types import Waypoint
rng = np.random.default_rng(1)
conditions = conditions_of(rules={"collision": "blocked", "drift": 0.1}, sensor={"noise": 0.1})
world = fit(Layout(strewn(rng)), conditions, rng)
state, told = world.reset(), sha256()
for _ in range(20):
    told.update(world.sense(state, rng).view.tobytes() + state.physics.tobytes())
    state = world.step(state, Waypoint(*(rng.uniform(-1, 1, 3) + state.told).tolist()), rng).state
print(told.hexdigest())
"""


def test_two_processes_simulate_the_same() -> None:
    """Every number of the physics, the scans and the odometry."""
    place = str(Path(fogbench.__file__).parents[1])
    command = [sys.executable, "-c", f"import sys; sys.path.append({place!r})\n{PROCESS}", str(Path(__file__).parent)]
    digests = {subprocess.run(command, check=True, capture_output=True, text=True).stdout for _ in range(2)}
    assert len(digests) == 1


def test_drift_stays(draw: Draw) -> None:
    """What is told moves away from the truth, and waypoints are meant where the robot takes itself to be."""
    world = draw(HALL, rules={"drift": 0.1, "physics": "unicycle"})
    rng, state, told = np.random.default_rng(1), world.reset(), []
    for _ in range(6):
        assert world.sense(state, rng).place == state.told
        x, y, heading = state.told
        done = world.step(state, Waypoint(x + 0.5 * np.cos(heading), y + 0.5 * np.sin(heading), heading), rng)
        state = done.state
        told.append(dist(state.told[:2], state.place[:2]))
    assert 0.002 < told[-1] < 1
    assert abs(state.place[1] - 1.5) < 1e-6  # straight ahead, whatever it believes


def test_without_drift_and_noise_no_number_is_drawn(draw: Draw) -> None:
    """The stream is untouched."""
    world, luck = draw(HALL), np.random.default_rng(0)
    world.sense(world.step(world.reset(), Waypoint(2.0, 1.5, 0.0), luck).state, luck)
    assert luck.random() == np.random.default_rng(0).random()


@pytest.mark.parametrize(
    ("action", "got"),
    [
        (1, "1 (int)"),
        ((1.0, 2.0, 0.0), "(1.0, 2.0, 0.0) (tuple)"),
        (Waypoint(float("nan"), 0.0, 0.0), "Waypoint(x=nan, y=0.0, heading=0.0) (Waypoint)"),
        (Waypoint("a", 0.0, 0.0), "Waypoint(x='a', y=0.0, heading=0.0) (Waypoint)"),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_waypoint_is_refused(draw: Draw, action: Any, got: str) -> None:
    """The error says what was got."""
    world = draw(HALL, rules={"physics": "unicycle"})
    with pytest.raises(TypeError) as caught:
        world.step(world.reset(), action, np.random.default_rng(0))
    assert str(caught.value) == f"act returned {got}; expected a Waypoint of finite numbers or None"


def test_nothing_that_is_handed_out_can_be_written(draw: Draw) -> None:
    """Views, cells and the state of the physics are read-only."""
    world = draw(HALL)
    state = world.reset()
    for array in (world.sense(state, np.random.default_rng(0)).view, world.cells, state.physics):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_worlds_are_what_the_rules_say(draw: Draw) -> None:
    """Recorded numbers are read back as waypoints."""
    assert type(draw(HALL)) is RobotWorld
    assert type(draw(HALL, rules={"physics": "unicycle"})) is UnicycleWorld
    assert draw(HALL).action(*np.array([1.0, 2.0, 0.5])) == Waypoint(1.0, 2.0, 0.5)


def test_a_picture_has_all_layers_upright(draw: Draw) -> None:
    """The walls as they were drawn, the shortest path beside them, beams, way, body and goal in rows from the top."""
    world = draw(WALL)
    known, observation = world.known(), world.sense(world.reset(), np.random.default_rng(0))
    known.update(observation)
    picture = world.picture(known, observation, [world.start, (1.6, 1.6, 0.0)])
    walls, expert = picture.truth
    assert isinstance(walls, Cells)
    assert isinstance(expert, Lines)
    assert picture.extent == (30, 60)
    assert np.argwhere(walls.readings == BLOCKED).min(0).tolist() == [10, 20]
    assert expert.ends[0, 0].round(9).tolist() == [14, 15]
    assert isinstance(picture.goal, Dots)
    assert picture.goal.at.round(9).tolist() == [[14.5, 44.5]]
    assert picture.path.ends.round(9).tolist() == [[[14.5, 14.5], [13.5, 15.5]]]  # type: ignore[union-attr]
    assert picture.view.ends.shape == (270, 2, 2)  # type: ignore[union-attr]
    assert np.argwhere(picture.known[0].readings == BLOCKED)[:, 1].tolist() == [20] * 10  # type: ignore[union-attr]
