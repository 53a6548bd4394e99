"""The words of the project: what an agent is told, what it answers, what an episode is made of.

Words used here
    place    where the agent is: grid `(row, column)`; graph a node; robot `(x [m], y [m], heading [rad])`
    view     what the sensor shows: grid [K, K] uint8 of UNKNOWN, FREE, BLOCKED; graph [N] bool; robot [R] float32 [m]
    H, W     rows and columns of a map;  K = 2 * radius + 1, the side of a view
    N, R     nodes of a graph;  beams of a lidar

Only the episode loop and the metrics ever hold a `World`. What an agent may know is its `Task`, told once, and an
`Observation`, told at every step. Nothing else.
"""

from collections.abc import Mapping, Sequence
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from fogbench.worlds.mistake import Mistake

if TYPE_CHECKING:
    from fogbench.worlds.picture import Picture

UNKNOWN, FREE, BLOCKED = 0, 1, 2
"""The three values of a cell in a view and in a known map."""

Array = NDArray[Any]
"""Any NumPy array; its shape and type are said where it is used."""

Cell = tuple[int, int]
"""`(row, column)`; rows grow downwards."""


class Move(IntEnum):
    """The four moves on a grid, in the paper's order, which is also the order that breaks ties."""

    DOWN = 0
    RIGHT = 1
    UP = 2
    LEFT = 3

    @property
    def delta(self) -> Cell:
        """`(rows, columns)` that the move adds to a cell."""
        return DELTAS[self]


DELTAS: tuple[Cell, ...] = ((1, 0), (0, 1), (-1, 0), (0, -1))
"""What each `Move` adds to `(row, column)`, in the order of `Move`."""


class Waypoint(NamedTuple):
    """A pose that the robot should drive to."""

    x: float  # [m]
    y: float  # [m]
    heading: float  # [rad]


class Budget(NamedTuple):
    """What an episode may use up."""

    steps: int
    """Decisions, at least 1."""
    hard_seconds: float = 300.0
    """Seconds after which an episode is ended from outside; the only clock that decides an outcome."""
    memory_bytes: int | None = None
    """Bytes an agent may carry from one decision to the next; None: any number."""


class Task(NamedTuple):
    """All that an agent is told before its first decision."""

    kind: str
    """A name of `fogbench.worlds.KINDS`, or of a kind that another package adds."""
    goal: Any
    """A place of that kind (robot: `(x, y)` [m])."""
    sensor: Any
    """The settings of the sensor, for example `fogbench.worlds.grid.rules.SquareView`."""
    budget: Budget
    extent: tuple[float, ...]
    """How large the map is: grid `(H, W)` [cells], graph `(N,)`, robot `(width, height)` [m]."""


class Observation(NamedTuple):
    """All that an agent is told at a step."""

    step: int
    """Decisions taken before this one, from 0."""
    place: Any
    view: Array
    """What the sensor shows from `place`; read-only."""
    blocked: bool
    """Whether an obstacle stopped the last action."""


class Step(NamedTuple):
    """What one action did."""

    state: Any
    """The world's next state."""
    length: float
    """Length travelled, in the unit of the kind (cells, edges, m)."""
    collided: bool
    reached: bool


class Known(Protocol):
    """**Protocol:** the world as far as one agent has seen it."""

    def update(self, observation: Observation) -> Any:
        """Take in one more observation."""


class Agent(Protocol):
    """**Protocol:** the decision maker of one episode; a new one is started for every episode."""

    def act(self, observation: Observation) -> Any:
        """The next action (`Move`, node or `Waypoint`), or None to give up."""

    def memory_bytes(self) -> int:
        """Bytes carried to the next decision: the `nbytes` of every array held, the C width of every queued entry."""

    def search_nodes(self) -> int:
        """Search effort so far, free of any machine: nodes expanded, or tree vertices added; 0 without a search."""


class AgentSettings(Protocol):
    """**Protocol:** the frozen settings of an agent; its fields are its block in a scenario."""

    kinds: ClassVar[frozenset[str]]
    """The kinds of world that the agent can play; in others it is skipped with a reason."""

    def start(self, task: Task, rng: np.random.Generator) -> Agent:
        """A fresh agent for one episode; `rng` is all the luck it may use."""

    def parameter_bytes(self) -> int:
        """Bytes of learned parameters; 0 for planners."""


class World(Protocol):
    """**Protocol:** the truth of one episode."""

    @property
    def task(self) -> Task:
        """What the agent is told before its first decision."""

    def reset(self) -> Any:
        """The state before the first decision."""

    def sense(self, state: Any, rng: np.random.Generator) -> Observation:
        """What the agent is told in `state`; draws the sensor's noise."""

    def step(self, state: Any, action: Any, rng: np.random.Generator) -> Step:
        """The effect of `action`; draws the slip.

        Raises:
            TypeError: `action` is not an action of this kind of world; the text says what was got and expected.
        """

    def shortest(self) -> float:
        """Length of the optimal path on the full map."""

    def straight(self) -> float:
        """Length that the optimal path would have if nothing were in the way."""

    def covariates(self) -> Mapping[str, float]:
        """How difficult the map and the task are, by names that are the same for all worlds of the kind."""

    def remaining(self, state: Any) -> float:
        """Length of the optimal path from `state` to the goal on the full map."""

    def known(self) -> Known:
        """What an agent knows that has seen nothing."""

    def action(self, *numbers: float) -> Any:
        """The action that a record has as these numbers."""

    def picture(self, known: Any, observation: Observation, path: Sequence[Any]) -> "Picture":
        """What a moment looks like.

        Args:
            known: made by `known`, and updated with all observations so far.
            observation: the last of them.
            path: the places so far, this one last.
        """


class MapFamily(Protocol):
    """**Protocol:** the frozen settings of a family of maps; its fields are its block under `maps:`.

    A family may also be `Marked`, and `Noted`.
    """

    kinds: ClassVar[tuple[str, ...]]
    """The kinds that its worlds can be, names of `fogbench.worlds.KINDS`; the first, unless a page says another."""

    def sample(self, rng: np.random.Generator, episode: int, conditions: Any) -> World:
        """The world of an episode under `conditions` (an object of the class that `fogbench.worlds.KINDS` names).

        Args:
            rng: all the luck of this map and task.
            episode: counts from 0; a family with a list of tasks takes the task of that number.
            conditions: all that a scenario says but for maps and agents: sensor, rules, bounds of the task, budget.

        Raises:
            MapError: no such world can be made.
        """

    def words(self) -> str:
        """All that fixes the maps, as text: the settings, and the digest of each file in place of its path."""

    def tasks(self, conditions: Any, most: int) -> int | None:
        """How many different episodes there are, counted no further than `most`; None: any number."""

    def extent(self) -> tuple[float, ...] | None:
        """The `Task.extent` of all its worlds; None: they differ, or a file has to be read to know."""


@runtime_checkable
class Marked(Protocol):
    """**Protocol:** a map family that knows moments of an episode at which something changes."""

    def moments(self, world: Any, path: Sequence[Any]) -> Mapping[str, int]:
        """Steps to mark, by name.

        Args:
            world: of the episode.
            path: the place of each decision, and the last.
        """


@runtime_checkable
class Noted(Protocol):
    """**Protocol:** a map family that reads files, where they may mean something else than a user thinks."""

    def notes(self) -> Sequence[str]:
        """How they were read, in one line each; nothing where they say it themselves.

        Raises:
            MapError: a file is broken.
        """


class MapError(Mistake):
    """A map or a task that cannot be made or read; its text is a line for each mistake, with the file or the family."""


class Outcome(Enum):
    """How an episode ended; the value is the sentence that a report prints. Checked in this order after a decision."""

    REACHED = "The goal was reached."
    COLLIDED = "A move ran into an obstacle, and the rules end an episode there."
    GAVE_UP = "The agent gave up."
    OUT_OF_STEPS = "The step budget was used up before the goal was reached."
    OUT_OF_MEMORY = "The agent carried more bytes from one decision to the next than its budget allows."
    HUNG = "The episode took longer than its hard limit and was ended from outside."
    CRASHED = "The agent raised an error, answered nonsense, or took its process down."
