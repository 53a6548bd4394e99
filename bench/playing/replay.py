"""A recorded episode, simulated again from its actions alone, and held against its record."""

from collections.abc import Generator, Mapping
from typing import Any, NamedTuple

import numpy as np

from fogbench.bench.playing.guests import drawn
from fogbench.bench.playing.loop import episode_stream
from fogbench.bench.reading.scenario import Variant
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.picture import Picture
from fogbench.worlds.types import Known, Observation, Outcome, World


class Moment(NamedTuple):
    """One step of an episode, as the world and the agent's own known map saw it."""

    world: World
    observation: Observation
    known: Known
    """The known map with this observation in it; overwritten by the next moment."""
    path: list[Any]
    """Places visited so far, this one last; grows with the next moment."""
    action: Any
    """What was done then; None at the last."""

    def picture(self) -> Picture:
        """What it looks like."""
        return self.world.picture(self.known, self.observation, self.path)


class End(NamedTuple):
    """How a simulated episode ended."""

    steps: int
    length: float
    reached: bool
    collided: bool


def retrace(variant: Variant, row: Mapping[str, Any]) -> Generator[Moment, None, End]:
    """Walk through a recorded episode; returns (as a generator does) its `End`.

    Args:
        variant: of the same scenario that was run.
        row: at least `episode`, `steps` and `actions`.
    """
    episode, steps = int(row["episode"]), int(row["steps"])
    world, luck = drawn(variant, episode), episode_stream(variant, "luck", episode)
    numbers = np.asarray(row["actions"], np.float64).reshape(steps, -1) if steps else ()  # [steps, any]
    known, path = world.known(), list[Any]()
    state, length, reached, collided = world.reset(), 0.0, False, False
    for action in (*(world.action(*each) for each in numbers), None):
        observation = world.sense(state, luck)
        known.update(observation)
        path.append(observation.place)
        yield Moment(world, observation, known, path, action)
        if action is not None:
            state, moved, collided, reached = world.step(state, action, luck)
            length += moved
    return End(steps, length, reached, collided)


def verify(row: Mapping[str, Any], end: End) -> None:
    """Hold a simulated end against the recorded row.

    Raises:
        Mistake: they differ, in one line.
    """
    recorded = (int(row["steps"]), float(row["length"]), row["outcome"] == Outcome.REACHED.name)
    again = (end.steps, end.length, end.reached)
    if recorded != again or end.collided != (row["outcome"] == Outcome.COLLIDED.name):
        raise Mistake(
            f"episode {row['episode']} of {row['agent']} in {row['variant']}: the replay took {end.steps} steps over "
            f"{end.length:g} and {'reached' if end.reached else 'did not reach'} the goal; recorded are "
            f"{row['steps']} steps over {row['length']:g} and {row['outcome']}."
        )
