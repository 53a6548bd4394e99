"""The truth of a ring.

Words used here
    N     stations, numbered round the ring
    link  number n joins station n and the next
    view  [2] uint8, the links clockwise and back: FREE or BLOCKED
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np

from fogbench import BLOCKED, FREE, Array, Dots, Lines, Observation, Picture, Step, Task


class Way(IntEnum):
    """Where one can go."""

    CLOCKWISE = 0
    BACK = 1


STRIDES = (1, -1)


class RingState(NamedTuple):
    """Where an episode stands."""

    step: int
    place: int
    blocked: bool


class KnownRing:
    """The links as far as one agent has seen them."""

    def __init__(self, size: int) -> None:
        """Nothing is known of `size` links."""
        self.links: Array = np.zeros(size, np.uint8)  # [N]

    def update(self, observation: Observation) -> None:
        """Write down the two links at the agent's station."""
        place = observation.place
        self.links[place], self.links[place - 1] = observation.view


def ahead(links: Array, place: int, goal: int) -> tuple[float, float]:
    """Links to the goal in both directions; infinite where one on the way is known to be cut."""
    size = len(links)
    clockwise = (goal - place) % size
    cut = np.roll(links == BLOCKED, -place)  # [N], from the agent's station on
    back = size - clockwise if clockwise else 0
    return (
        np.inf if cut[:clockwise].any() else float(clockwise),
        np.inf if cut[size - back :].any() else float(back),
    )


@dataclass(frozen=True, eq=False)
class RingWorld:
    """One ring with one task."""

    links: Array
    """[N] uint8 of FREE, BLOCKED."""
    start: int
    task: Task
    slip: float

    def reset(self) -> RingState:
        """At the start."""
        return RingState(0, self.start, blocked=False)

    def sense(self, state: RingState, rng: np.random.Generator) -> Observation:
        """The two links here; no luck is needed."""
        del rng
        view = self.links[[state.place, state.place - 1]]
        view.setflags(write=False)
        return Observation(state.step, state.place, view[:], state.blocked)

    def step(self, state: RingState, action: Any, rng: np.random.Generator) -> Step:
        """Go one link on, or stay: a cut link costs a step, and so does a slip."""
        if type(action) is not Way:
            raise TypeError(f"act returned {action!r} ({type(action).__name__}); expected a Way or None")
        link = state.place - (action is Way.BACK)
        cut, slips = self.links[link] == BLOCKED, rng.random() < self.slip
        place = state.place if cut or slips else (state.place + STRIDES[action]) % len(self.links)
        after = RingState(state.step + 1, place, blocked=bool(cut))
        return Step(after, float(place != state.place), collided=False, reached=place == self.task.goal)

    def shortest(self) -> float:
        """Over the links that are not cut."""
        return min(ahead(self.links, self.start, self.task.goal))

    def straight(self) -> float:
        """If no link were cut."""
        return min(ahead(np.full_like(self.links, FREE), self.start, self.task.goal))

    def remaining(self, state: RingState) -> float:
        """Over the links that are not cut."""
        return min(ahead(self.links, state.place, self.task.goal))

    def covariates(self) -> Mapping[str, float]:
        """How many stations there are."""
        return {"stations": float(len(self.links))}

    def known(self) -> KnownRing:
        """Of an agent that has seen nothing."""
        return KnownRing(len(self.links))

    def action(self, *numbers: float) -> Way:
        """The way of a recorded number."""
        (number,) = numbers
        return Way(int(number))

    def picture(self, known: KnownRing, observation: Observation, path: Sequence[int]) -> Picture:
        """Stations on a circle, and the links that there are, or that are known."""
        dots = Dots(_on_circle(np.arange(len(self.links)), len(self.links)))
        here, goal = (Dots(_on_circle(np.array([n]), len(self.links))) for n in (observation.place, self.task.goal))
        return Picture(
            extent=(10.0, 10.0),
            truth=(self._lines(self.links == FREE), dots),
            known=(self._lines(known.links == FREE), dots),
            view=self._lines(np.isin(np.arange(len(self.links)), [observation.place, observation.place - 1])),
            path=Dots(_on_circle(np.array(path), len(self.links))),
            agent=here,
            goal=goal,
        )

    def _lines(self, shown: Array) -> Lines:
        links = np.flatnonzero(shown)
        ends = np.stack([links, links + 1], 1)  # [n, 2]
        return Lines(_on_circle(ends.ravel(), len(self.links)).reshape(-1, 2, 2))


def _on_circle(stations: Array, size: int) -> Array:
    """[n, 2] rows and columns."""
    angle = 2 * np.pi * stations / size
    return np.stack([4.5 - 4 * np.cos(angle), 4.5 + 4 * np.sin(angle)], 1)
