"""One episode of a scenario, from its variant and agent to a row; whatever the agent does, there is one."""

from dataclasses import fields
from functools import cache, lru_cache
from inspect import getfile
from itertools import chain
from traceback import extract_tb
from typing import Any

from fogbench.bench.playing.episode import Episode
from fogbench.bench.playing.facts import facts, numbers
from fogbench.bench.playing.keys import agent_key, world_key
from fogbench.bench.playing.loop import Clerk, ClerkError, Record, episode_stream, episode_world, start_and_roll
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.reading.tables import AGENT
from fogbench.bench.reading.variant import Entry
from fogbench.planners import judge_of
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import AgentSettings, Outcome, World

TOLD = 300
"""Characters of an agent's error that a row holds at most."""


def play(scenario: Scenario, variant: Variant, entry: Entry, episode: int, workers: int) -> Episode:
    """Play one episode.

    Raises:
        MapError: the map family cannot make the world.
    """
    assert entry.settings is not None
    world, record = episode_world(variant, episode), Record()
    clerk = Clerk(world, _judge(variant, world), record)
    _practice(variant)  # outside of what the agent answers for
    try:
        _warm_up(variant, entry)
        start_and_roll(world, entry.settings, variant, episode, record, clerk)
    except ClerkError:
        raise
    except BaseException as error:  # noqa: BLE001  an agent may raise anything, and nobody else speaks to a worker
        record.outcome, record.detail = Outcome.CRASHED, _sentence(error, entry.settings)
    return _episode(scenario, variant, entry, episode, workers, record)


def prepare(scenario: Scenario) -> None:
    """Compile what ships with the project before the limit of any episode counts; a user's agent warms up under it."""
    for variant in scenario.variants[:1]:
        facts(variant, 0)
        for entry in variant.agents:
            if entry.settings is not None and entry.target in AGENT.shipped.values():
                _warm_up(variant, entry)


def lost(
    scenario: Scenario, variant: Variant, entry: Entry, episode: int, workers: int, outcome: Outcome, detail: str
) -> Episode:
    """The record of an episode whose process hung or died: the facts of its world, and no decisions."""
    return _episode(scenario, variant, entry, episode, workers, Record(outcome=outcome, detail=detail))


def _judge(variant: Variant, world: World) -> Any:
    judge = judge_of(variant.kind)
    return judge(world.task) if judge else None


@lru_cache(maxsize=16)
def _practice(variant: Variant) -> World:
    """A throw-away world of the same kind and size."""
    return variant.family.sample(episode_stream(variant, "warm-up map", 0), 0, variant.conditions)


@cache
def _warm_up(variant: Variant, entry: Entry) -> None:
    """One decision on a throw-away task in each process, so that no compilation and no first call is ever timed."""
    assert entry.settings is not None
    practice, rng = _practice(variant), episode_stream(variant, "warm-up", 0)
    try:
        agent, state = entry.settings.start(practice.task, rng), practice.reset()
    except Mistake:  # it is not for such a map, but may be for the episode's
        return
    clerk, observation = Clerk(practice, _judge(variant, practice), Record()), practice.sense(state, rng)
    action = agent.act(observation)
    agent.memory_bytes()
    clerk.stands(state)
    if action is not None:
        practice.step(state, action, rng)
        clerk.decided(observation, action)


def _sentence(error: BaseException, settings: AgentSettings) -> str:
    """An agent's error in one line, with the place in the agent's own file, if it comes from there."""
    own = [frame for frame in extract_tb(error.__traceback__) if frame.filename == getfile(type(settings))]
    place = f" ({own[-1].name}, line {own[-1].lineno})" if own else ""
    try:
        text = " ".join(str(error).split()) or "no text"
    except Exception:  # noqa: BLE001  it is the agent's own class
        text = "no text"
    text = text.encode("utf-8", "backslashreplace").decode()  # a lone surrogate cannot be stored
    return f"{type(error).__name__}: {text if len(text) <= TOLD else text[:TOLD] + '...'}{place}"


def _episode(scenario: Scenario, variant: Variant, entry: Entry, episode: int, workers: int, record: Record) -> Episode:
    kept = {each.name: getattr(record, each.name) for each in fields(Record)}
    kept |= {name: tuple(kept[name]) for name in ("remaining", "decision_seconds")}
    kept |= {"outcome": record.outcome.name, "actions": tuple(chain.from_iterable(map(numbers, record.actions)))}
    return Episode(
        scenario=scenario.name,
        variant=variant.name,
        agent=entry.label,
        episode=episode,
        steps=len(record.actions),
        workers=workers,
        agent_key=agent_key(entry),
        world_key=world_key(variant),
        **facts(variant, episode),
        **kept,
    )
