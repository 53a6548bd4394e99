"""One episode of a scenario, from its variant and agent to a row; whatever the agent does, there is one."""

from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import cache, lru_cache
from inspect import getfile
from itertools import chain
from traceback import extract_tb, format_exception
from typing import Any, NamedTuple

from fogbench.bench.playing.episode import Episode
from fogbench.bench.playing.facts import facts, numbers
from fogbench.bench.playing.guests import drawn, hosted, is_guest
from fogbench.bench.playing.keys import agent_key, world_key
from fogbench.bench.playing.loop import Clerk, ClerkError, Record, episode_stream, start_and_roll
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.reading.variant import Entry
from fogbench.planners import judge_of
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import AgentSettings, Outcome, World

TOLD = 300
"""Characters of an agent's error that a row holds at most."""

LONGEST = 100_000
"""Characters of a traceback at most."""


class Rehearsed(NamedTuple):
    """A decision on a throw-away task."""

    wrong: str
    """What its agent did wrong, in one line; empty if nothing."""


def play(
    scenario: Scenario,
    variant: Variant,
    entry: Entry,
    episode: int,
    workers: int,
    told: Callable[[str], object] | None = None,
) -> Episode:
    """Play one episode; where its agent crashes, somebody may be told the traceback.

    Raises:
        MapError: the map family cannot make the world.
    """
    assert entry.settings is not None
    world, record = drawn(variant, episode), Record()
    clerk = Clerk(world, _judge(variant, world), record)
    _practice(variant)  # outside of what the agent answers for
    try:
        _warm_up(variant, entry)
        with hosted(variant, "agent", episode, entry.settings, variant.family):
            start_and_roll(world, entry.settings, variant, episode, record, clerk)
    except ClerkError:
        raise
    except BaseException as error:  # noqa: BLE001  an agent may raise anything, and nobody else speaks to a worker
        record.outcome, record.detail = Outcome.CRASHED, _sentence(error, entry.settings)
        if told is not None:
            told(_traceback(error))
    return _episode(scenario, variant, entry, episode, workers, record)


def prepare(scenario: Scenario) -> None:
    """Compile what ships with the project before the limit of any episode counts; a user's agent warms up under it."""
    for variant in scenario.variants[:1]:
        _facts(variant, 0)
        for entry in variant.agents:
            if entry.settings is not None and not is_guest(entry.settings):
                _warm_up(variant, entry)


def lost(
    scenario: Scenario, variant: Variant, entry: Entry, episode: int, workers: int, outcome: Outcome, detail: str
) -> Episode:
    """The record of an episode whose process hung or died: the facts of its world, and no decisions."""
    return _episode(scenario, variant, entry, episode, workers, Record(outcome=outcome, detail=detail))


def rehearse(variant: Variant, entry: Entry) -> Rehearsed:
    """Let an agent take one decision on a throw-away task, and ask it all that an episode asks."""
    assert entry.settings is not None
    practice, record = _Brief(_practice(variant)), Record()
    try:
        with hosted(variant, "warm-up", 0, entry.settings, variant.family):
            start_and_roll(practice, entry.settings, variant, 0, record, None)
    except BaseException as error:  # noqa: BLE001  as in an episode
        if isinstance(error, Mistake) and not record.setup_seconds:  # it is not for such a map, but may be for others
            return Rehearsed("")
        return Rehearsed(_sentence(error, entry.settings))
    return Rehearsed("")


class _Brief:
    """A world that is over after one step."""

    def __init__(self, world: World) -> None:
        self.world = world

    def __getattr__(self, name: str) -> Any:
        return getattr(self.world, name)

    def step(self, *arguments: Any) -> Any:
        """The step of the world, and the last."""
        return self.world.step(*arguments)._replace(reached=True)


def _judge(variant: Variant, world: World) -> Any:
    judge = judge_of(variant.kind)
    return judge(world.task) if judge else None


@lru_cache(maxsize=16)
def _practice(variant: Variant) -> World:
    """A throw-away world of the same kind and size."""
    with hosted(variant, "warm-up map", 0, variant.family):
        return variant.family.sample(episode_stream(variant, "warm-up map", 0), 0, variant.conditions)


@cache
def _warm_up(variant: Variant, entry: Entry) -> None:
    """One decision on a throw-away task in each process, so that no compilation and no first call is ever timed."""
    assert entry.settings is not None
    practice, rng = _practice(variant), episode_stream(variant, "warm-up", 0)
    with hosted(variant, "warm-up", 0, entry.settings, variant.family):
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
        text = " ".join(str(error)[: 10 * TOLD].split()) or "no text"
    except Exception:  # noqa: BLE001  it is the agent's own class
        text = "no text"
    text = text.encode("utf-8", "backslashreplace").decode()  # a lone surrogate cannot be stored
    return f"{' '.join(type(error).__name__.split())}: {text if len(text) <= TOLD else text[:TOLD] + '...'}{place}"


def _traceback(error: BaseException) -> str:
    text = "".join(format_exception(error))
    return text[:LONGEST].encode("utf-8", "backslashreplace").decode()


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
        **_facts(variant, episode),
        **kept,
    )


def _facts(variant: Variant, episode: int) -> Mapping[str, Any]:
    drawn(variant, episode)
    with hosted(variant, "reference", episode, variant.family):
        return facts(variant, episode)
