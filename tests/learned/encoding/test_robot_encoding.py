"""What networks see of robots' worlds, against plain loops from the definitions."""

from math import atan2, cos, hypot, log1p, pi, sin
from typing import Any

import numpy as np
import pytest
import torch

from fogbench.learned.encoding.robot import RobotEncoding, RobotViewpoint
from fogbench.learned.encoding.robot_sizes import BEARINGS, CHOICES, SECTORS, seen_count
from fogbench.learned.macn_robot import MacnRobot
from fogbench.planners.robot import choices
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.robot.world import RobotWorld
from fogbench.worlds.types import Array, Observation, Task

POLICY = MacnRobot(checkpoint="none", memory="lstm", features=16, hidden=16)

ENCODING = RobotEncoding(POLICY)

BLOCKS: list[dict[str, Any]] = [{}, {"beams": 60, "field": 360.0, "range": 4.0, "noise": 0.02, "dropped": 0.1}]


def drawn(seed: int, **sensor: Any) -> RobotWorld:
    """A world of 9 x 9 m with rectangles, without MuJoCo."""
    family, blocks = Blobs(size=90, obstacles=(8, 14), obstacle_size=(3, 12)), {"rules": {"physics": "unicycle"}}
    conditions = RobotConditions.model_validate({**blocks, "sensor": sensor, "budget": {"steps": 60}})
    world: Any = family.sample(np.random.default_rng(seed), 0, conditions)
    return world


def walked(world: RobotWorld, outputs: Array) -> tuple[RobotViewpoint, Any]:
    """A viewpoint after its last look, and the state there, of a robot that makes some choices until it touches."""
    viewpoint, state, luck = ENCODING.start(world.task), world.reset(), np.random.default_rng(3)
    viewpoint.see(world.sense(state, luck))
    for output in outputs.tolist():
        step = world.step(state, viewpoint.act(output), luck)
        state = step.state
        viewpoint.see(world.sense(state, luck))
        if step.collided or step.reached:
            break
    return viewpoint, state


def looks(count: int) -> list[tuple[RobotWorld, RobotViewpoint, Any]]:
    """Viewpoints of robots that made five random choices."""
    found = []
    for seed in range(count):
        world = drawn(seed, **BLOCKS[seed % 2])
        outputs = np.random.default_rng(seed).integers(CHOICES, size=5)
        found.append((world, *walked(world, outputs)))
    return found


def as_seen(place: tuple[float, float, float], x: float, y: float) -> tuple[float, float]:
    """A point in the robot's frame: forward, left."""
    across, along = x - place[0], y - place[1]
    return (
        across * cos(place[2]) + along * sin(place[2]),
        -across * sin(place[2]) + along * cos(place[2]),
    )


def bearings(observation: Observation, task: Task) -> Array:
    """[R] float64, of all beams."""
    beams, field = len(observation.view), task.sensor.lidar.arc
    return field * ((np.arange(beams) + 0.5) / beams - 0.5)


def test_sizes_say_what_there_is() -> None:
    """Those that are known without Numba are those of the choices and of the inputs."""
    _, viewpoint, _ = looks(1)[0]
    inputs = ENCODING.encode([viewpoint])
    assert CHOICES == len(choices.CHOICES) == len(ENCODING.outputs)
    assert sum(part.shape[1] for part in inputs.beside) == seen_count(10) == POLICY.seen_count
    assert inputs.cells.tolist() == [95]


def test_an_image_is_what_beams_cross_and_meet() -> None:
    """By a walk along each beam, a millimetre at a time: cells it passes are free, that where it ends is blocked."""
    for world, viewpoint, state in looks(8):
        observation, free, blocked = viewpoint.observation, np.zeros((10, 10)), np.zeros((10, 10))
        for angle, far in zip(bearings(observation, world.task), observation.view.tolist(), strict=True):
            ways = np.arange(0, far, 0.001) if far else np.zeros(1)
            rows, columns = np.floor(ways * cos(angle) / 0.5), np.floor(5 - ways * sin(angle) / 0.5)
            inside = (rows >= 0) & (rows < 10) & (columns >= 0) & (columns < 10)
            free[9 - rows[inside].astype(int), columns[inside].astype(int)] = 1
            row, column = int(far * cos(angle) // 0.5), int((5 - far * sin(angle) / 0.5) // 1)
            if 0 < far < world.task.sensor.lidar.range and 0 <= row < 10 and 0 <= column < 10:
                blocked[9 - row, column] = 1
        blocked.flat[95] = 0
        image = ENCODING.encode([viewpoint]).image[0].numpy()
        assert np.array_equal(image[1], blocked)
        assert np.sum(image[0] != free * (1 - blocked)) <= 1  # a corner may be cut by less than a millimetre
        assert not (image[0] * image[1]).any()
        ahead, left = as_seen(state.told, *world.task.goal)
        row, column = np.clip([int(np.floor(ahead / 0.5)), int(np.floor(5 - left / 0.5))], 0, 9)
        assert np.argwhere(image[2]).tolist() == [[9 - row, column]]


def test_beams_tell_the_nearest_of_each_sector() -> None:
    """From behind counterclockwise, less the radius: how near within each ring, then how far within 5 m."""
    for world, viewpoint, _ in looks(6):
        observation, least = viewpoint.observation, np.full(SECTORS, np.inf)
        for angle, far in zip(bearings(observation, world.task), observation.view.tolist(), strict=True):
            sector = int((angle / (2 * pi) + 0.5) * SECTORS) % SECTORS
            least[sector] = min(least[sector], max(far - 0.2, 0.0) if far else np.inf)
        beams = ENCODING.encode([viewpoint]).beams[0].numpy().reshape(5, SECTORS)
        near = np.maximum(1 - least / np.array([[0.25], [0.5], [1], [2]]), 0)
        assert np.allclose(beams[:4], near, atol=1e-6)
        assert np.allclose(beams[4], np.minimum(least / 5, 1), atol=1e-6)


def test_a_compass_by_hand() -> None:
    """The goal's direction and distance, speeds, the last step and choice, and the place on the map."""
    world = drawn(0)
    viewpoint, state = walked(world, np.array([choices.NAMES.index("0.6 m ahead, 0.2 m left")]))
    (x, y, heading), goal = state.place, world.task.goal
    compass = ENCODING.encode([viewpoint]).compass[0].numpy()
    direction = np.sum(compass[:BEARINGS] * np.exp(2j * pi * (np.arange(BEARINGS) / BEARINGS - 0.5)))
    ahead, left = as_seen(state.place, *goal)
    assert np.angle(direction) == pytest.approx(atan2(left, ahead), abs=0.02)
    assert compass[:BEARINGS].sum() == pytest.approx(1)
    far = hypot(ahead, left)
    expected = [log1p(far), min(far / 5, 1), state.v / 1.0, state.w / 2.0]
    expected += [*as_seen(world.start, x, y), heading - world.start[2], 0.6, 0.2]
    turn = atan2(0.2, 0.6)
    expected += [cos(turn), sin(turn), 0, cos(heading), sin(heading)]
    waves = [pi * share * side / 9 for side in (x, y, *goal) for share in (1, 2, 4)]
    expected += [part for wave in waves for part in (cos(wave), sin(wave))]
    assert np.allclose(compass[BEARINGS:], expected, atol=1e-5)


def test_a_viewpoint_knows_how_fast_it_drives() -> None:
    """As its wheels were told; who was stopped stands."""
    for seed in range(6):
        world = drawn(seed)
        viewpoint, state = walked(world, np.random.default_rng(seed).integers(CHOICES, size=7))
        assert viewpoint.speeds == pytest.approx((state.v, state.w))
        assert viewpoint.bytes == 0


def test_many_are_seen_as_one() -> None:
    """Lidars of other numbers of beams in one batch change nothing."""
    viewpoints = [viewpoint for _, viewpoint, _ in looks(6)]
    together = ENCODING.encode(viewpoints)
    assert together.to("cpu") is together
    for b, viewpoint in enumerate(viewpoints):
        alone = ENCODING.encode([viewpoint])
        for mine, theirs in zip(alone[:4], together[:4], strict=True):
            assert torch.equal(mine[0], theirs[b])
        assert np.array_equal(ENCODING.open(alone)[0], ENCODING.open(together)[b])


def test_open_is_what_can_be_driven_on_the_map_of_one_scan() -> None:
    """On a whole map with nothing on it but this scan, in the world's own cells."""
    closed = 0
    for world, viewpoint, state in looks(12):
        known, told = RobotMap(world.task), np.empty(CHOICES, np.bool_)
        known.update(viewpoint.observation)
        body = world.task.sensor.body
        choices.can_drive(
            known.cells, 0.1, body.radius, state.told, *viewpoint.speeds,
            choices.CHOICES, body.stride, body.limits, body.ticks, told,
        )  # fmt: skip
        is_open = ENCODING.open(ENCODING.encode([viewpoint]))[0]
        assert np.mean(is_open == told) > 0.99  # the border counts as wall there before it was seen
        closed += int((~is_open).sum())
        assert is_open[-choices.TURNS :].all()
    assert closed > 50


@pytest.mark.parametrize("masked", [True, False])
def test_who_is_masked_takes_no_closed_choice(masked: bool) -> None:
    """Whatever a network says, in whole episodes; who is not masked does."""
    policy, was_open = POLICY.model_copy(update={"masked": masked}), list[bool]()
    torch.manual_seed(0)
    for seed in range(6):
        world, luck = drawn(seed), np.random.default_rng(seed)
        agent: Any = policy.start(world.task, luck)
        agent.network = lambda inputs, state: (torch.randn(len(inputs.image), CHOICES), state)
        state = world.reset()
        for _ in range(25):
            observation = world.sense(state, luck)
            waypoint = agent.act(observation)
            (output,) = np.flatnonzero((agent.viewpoint.last == choices.CHOICES).all(1))
            was_open.append(bool(opened(world, observation, state)[output]))
            step = world.step(state, waypoint, luck)
            state = step.state
            if step.collided or step.reached:
                break
    assert all(was_open) == masked


def opened(world: RobotWorld, observation: Observation, state: Any) -> Array:
    """[A] bool, the choices that are open to a robot at its true speeds."""
    viewpoint = ENCODING.start(world.task)
    viewpoint.see(observation)
    viewpoint.speeds = state.v, state.w
    is_open: Array = ENCODING.open(ENCODING.encode([viewpoint]))[0]
    return is_open
