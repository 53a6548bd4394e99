"""A recorded episode, simulated again from its actions alone, and held against its record."""

from collections.abc import Generator, Mapping
from typing import Any, NamedTuple

from fogbench.bench.playing.loop import episode_stream, episode_world
from fogbench.bench.reading.scenario import Variant
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array, Cell, Move, Observation, Outcome


class Moment(NamedTuple):
    """One step of an episode, as the world and the agent's own known map saw it."""

    world: GridWorld
    observation: Observation
    known: Array
    """[H, W] uint8, the known map with this observation in it; overwritten by the next moment."""
    path: list[Cell]
    """Cells visited so far, this one last; grows with the next moment."""


class End(NamedTuple):
    """How a simulated episode ended."""

    steps: int
    length: float
    reached: bool
    collided: bool


def retrace(variant: Variant, episode: int, actions: Array) -> Generator[Moment, None, End]:
    """Walk through an episode; returns (as a generator does) its `End`.

    Args:
        variant: of the same scenario that was run.
        episode: its number.
        actions: [n] float, the recorded actions.
    """
    world = episode_world(variant, episode)
    assert isinstance(world, GridWorld)
    luck = episode_stream(variant, "luck", episode)
    known, path = KnownMap(world.task.extent), list[Cell]()
    state, length, reached, collided = world.reset(), 0.0, False, False
    for action in [*actions, None]:
        observation = world.sense(state, luck)
        known.update(observation)
        path.append(observation.place)
        yield Moment(world, observation, known.cells, path)
        if action is not None:
            state, moved, collided, reached = world.step(state, Move(int(action)), luck)
            length += moved
    return End(len(actions), length, reached, collided)


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
