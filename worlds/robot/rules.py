"""What a robot is, what its lidar shows, how its walls are made of cells, and what happens when it touches one."""

from math import isclose, radians
from typing import Annotated, Literal, NamedTuple

from pydantic import AfterValidator, Field

from fogbench.worlds.settings import Probability, Settings
from fogbench.worlds.types import Task

TICK = 0.02
"""Seconds between two commands to the wheels."""

Metres = Annotated[float, Field(gt=0, le=1000)]
"""A length above 0 [m]."""

Pace = Annotated[float, Field(gt=0, le=100)]
"""A speed or an acceleration above 0."""


def _whole_ticks(seconds: float) -> float:
    ticks = round(seconds / TICK)
    if not (ticks and isclose(ticks * TICK, seconds)):
        raise ValueError(f"a multiple of {TICK} s")
    return seconds


def _ascending(bounds: tuple[float, float]) -> tuple[float, float]:
    if bounds[0] > bounds[1]:
        raise ValueError("two numbers, the smaller first")
    return bounds


class Walls(Settings):
    """How cells of a map become walls: each blocked cell is a block, and all around the map is wall."""

    cell: Metres = 0.1
    """Side of a cell of the map family [m]."""
    split: Annotated[int, Field(ge=1, le=100)] = 1
    """A cell of the family is so many cells of the known map wide and high."""

    @property
    def side(self) -> float:
        """Of a cell of the known map [m]."""
        return self.cell / self.split


class Body(Settings):
    """A round body with two driven wheels, and how it is driven."""

    radius: Annotated[float, Field(ge=0.05, le=2)] = 0.2
    """[m]"""
    speed: Pace = 1.0
    """The most it drives [m/s]."""
    turn: Pace = 2.0
    """The most it turns [rad/s]."""
    acceleration: Pace = 2.0
    """[m/s2]"""
    turn_acceleration: Pace = 8.0
    """[rad/s2]"""
    decision: Annotated[float, Field(ge=TICK, le=60), AfterValidator(_whole_ticks)] = 0.5
    """Seconds that each waypoint is driven for."""
    stride: Metres = 1.0
    """A waypoint that is farther away is drawn in to this distance [m]."""

    @property
    def limits(self) -> tuple[float, float, float, float]:
        """Speed, turn, and what both may change by in a tick."""
        return self.speed, self.turn, self.acceleration * TICK, self.turn_acceleration * TICK

    @property
    def ticks(self) -> int:
        """Of a decision."""
        return round(self.decision / TICK)


class Lidar(Settings):
    """A laser that turns in the middle of the body; its beams are spread evenly around the heading."""

    beams: Annotated[int, Field(ge=1, le=10_000)] = 270
    """How many."""
    field: Annotated[float, Field(gt=0, le=360)] = 270.0
    """Degrees that they are spread over."""
    range: Annotated[float, Field(gt=0, le=200)] = 10.0
    """A beam reads this where nothing is nearer [m]."""
    noise: Annotated[float, Field(ge=0, le=1)] = 0.0
    """Standard deviation of a reading that meets a wall [m], drawn afresh at every look."""
    dropped: Probability = 0.0
    """Probability that a beam reads 0, which tells nothing."""

    @property
    def arc(self) -> float:
        """The field [rad]."""
        return radians(self.field)


class RobotRules(Settings):
    """What happens when the robot touches a wall, and how exact its world is."""

    collision: Literal["fails", "blocked"] = "fails"
    """A touch ends the episode (`fails`), or the wall holds the robot up (`blocked`)."""
    drift: Annotated[float, Field(ge=0, le=1)] = 0.0
    """Standard deviation of what its odometry gets wrong, in m per m and rad per rad, and rad per m, driven."""
    physics: Literal["mujoco", "unicycle"] = "mujoco"
    """Wheels, friction and contacts in MuJoCo, or a disc that moves exactly as its wheels are told."""


class RobotTasks(Settings):
    """The `tasks` block of robots: which tasks are drawn."""

    distance: Annotated[tuple[Metres, Metres], AfterValidator(_ascending)] | None = None
    """Bounds of the full-map optimum [m]; by default 1 m and what full speed covers in the step budget."""
    clearance: Metres = 0.35
    """From start and goal to the nearest wall at least [m]; never less than the body's radius."""
    goal_radius: Metres = 0.3
    """The goal is reached where the middle of the body is this near [m]."""


class Outfit(NamedTuple):
    """What a robot is told of itself: the `sensor` of its task."""

    lidar: Lidar
    body: Body
    cell: float
    """Side of a cell of the known map [m]."""
    goal_radius: float


def shape_of(task: Task) -> tuple[int, int]:
    """Rows and columns of the known map of a task."""
    width, height = task.extent
    return round(height / task.sensor.cell), round(width / task.sensor.cell)
