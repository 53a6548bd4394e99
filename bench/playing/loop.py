"""The episode loop: the only place that holds a world and an agent at once."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, lru_cache
from inspect import getfile
from operator import index
from time import perf_counter
from traceback import extract_tb
from typing import Any

import numpy as np

from fogbench.bench.playing.episode import Episode
from fogbench.bench.playing.judge import GridJudge
from fogbench.bench.playing.keys import agent_key, world_key
from fogbench.bench.reading.scenario import Entry, Scenario, Variant
from fogbench.bench.reading.tables import AGENT
from fogbench.planners.astar import AStar
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.streams import stream
from fogbench.worlds.types import Agent, AgentSettings, Outcome, World

TOLD = 300
"""Characters of an agent's error that a row holds at most."""

JUDGES = {"grid": GridJudge}
"""What judges the decisions of an agent, by the kind of world; other kinds are not judged."""


@dataclass(slots=True)
class Record:
    """What one agent did in one world, as it goes on."""

    outcome: Outcome = Outcome.CRASHED
    length: float = 0.0
    setup_seconds: float = 0.0
    decision_seconds: list[float] = field(default_factory=list)
    peak_memory_bytes: int = 0
    search_nodes: int = 0
    parameter_bytes: int = 0
    actions: list[Any] = field(default_factory=list)
    detail: str = ""


def play(scenario: Scenario, variant: Variant, entry: Entry, episode: int, workers: int) -> Episode:
    """Play one episode; whatever the agent raises or answers, there is a record of it.

    Raises:
        MapError: the map family cannot make the world.
    """
    assert entry.settings is not None
    world = episode_world(variant, episode)
    _practice(variant)  # outside of what the agent answers for
    judge = JUDGES[world.task.kind](world.task) if world.task.kind in JUDGES else None
    record = Record()
    try:
        _warm_up(variant, entry)
        start_and_roll(world, entry.settings, variant, episode, record, judge)
    except BaseException as error:  # noqa: BLE001  an agent may raise anything, and nobody else speaks to a worker
        record.outcome, record.detail = Outcome.CRASHED, _sentence(error, entry.settings)
    return _episode(scenario, variant, entry, episode, workers, record, judge)


def prepare(scenario: Scenario) -> None:
    """Compile what ships with the project before the limit of any episode counts; a user's agent warms up under it."""
    for variant in scenario.variants[:1]:
        _facts(variant, 0)
        for entry in variant.agents:
            if entry.settings is not None and entry.target in AGENT.shipped.values():
                _warm_up(variant, entry)


def lost(
    scenario: Scenario, variant: Variant, entry: Entry, episode: int, workers: int, outcome: Outcome, detail: str
) -> Episode:
    """The record of an episode whose process hung or died: the facts of its world, and no decisions."""
    record = Record(outcome=outcome, detail=detail)
    return _episode(scenario, variant, entry, episode, workers, record, None)


def roll(world: World, agent: Agent, luck: np.random.Generator, record: Record, judge: GridJudge | None) -> Outcome:
    """Let the agent decide until the episode is over, and write everything down."""
    budget, state = world.task.budget, world.reset()
    limit = budget.memory_bytes or np.inf
    while True:
        observation = world.sense(state, luck)
        began = perf_counter()
        action = agent.act(observation)
        record.decision_seconds.append(perf_counter() - began)
        carried = _count(agent.memory_bytes(), "memory_bytes")
        record.peak_memory_bytes = max(record.peak_memory_bytes, carried)
        if action is None:
            return Outcome.GAVE_UP
        step = world.step(state, action, luck)
        if judge is not None:
            judge.see(observation, action)
        state = step.state
        record.actions.append(action)
        record.length += step.length
        if step.reached:
            return Outcome.REACHED
        if step.collided:
            return Outcome.COLLIDED
        if len(record.actions) >= budget.steps:
            return Outcome.OUT_OF_STEPS
        if carried > limit:
            return Outcome.OUT_OF_MEMORY


def start_and_roll(
    world: World, settings: AgentSettings, variant: Variant, episode: int, record: Record, judge: GridJudge | None
) -> None:
    """One bare episode, from the start of the agent, written into `record` as it goes on."""
    luck, own = (episode_stream(variant, purpose, episode) for purpose in ("luck", "agent"))
    record.parameter_bytes = _count(settings.parameter_bytes(), "parameter_bytes")
    began = perf_counter()
    agent = settings.start(world.task, own)
    record.setup_seconds = perf_counter() - began
    record.outcome = roll(world, agent, luck, record, judge)
    record.search_nodes = _count(agent.search_nodes(), "search_nodes")


def episode_stream(variant: Variant, purpose: str, episode: int) -> np.random.Generator:
    """Worlds that differ in their sensor or their rules alone are drawn from the same stream: they share their maps."""
    return stream(variant.seed, variant.family.words(), purpose, episode)


@lru_cache(maxsize=16)
def episode_world(variant: Variant, episode: int) -> World:
    """The world of an episode; the last few are kept, for agents that meet the same one.

    Raises:
        MapError: the map family cannot make it.
    """
    return variant.family.sample(episode_stream(variant, "map", episode), episode, variant.conditions)


@lru_cache(maxsize=16)
def _facts(variant: Variant, episode: int) -> Mapping[str, Any]:
    """What the record of an episode says of its world, whoever plays."""
    world = episode_world(variant, episode)
    return {
        "kind": world.task.kind,
        "budget_steps": world.task.budget.steps,
        "straight": world.straight(),
        "shortest": world.shortest(),
        "reference_length": _reference_length(world, variant, episode),
        **world.covariates(),
    }


def _reference_length(world: World, variant: Variant, episode: int) -> float | None:
    """Length that A* on the map seen so far travels in the same world; None where it does not reach the goal."""
    if world.task.kind not in AStar.kinds:
        return None
    record = Record()
    start_and_roll(world, AStar(), variant, episode, record, None)
    return record.length if record.outcome is Outcome.REACHED else None


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
    observation = practice.sense(state, rng)
    action = agent.act(observation)
    agent.memory_bytes()
    if action is not None:
        practice.step(state, action, rng)
        if practice.task.kind in JUDGES:
            JUDGES[practice.task.kind](practice.task).see(observation, action)


def _count(number: Any, name: str) -> int:
    try:
        count = index(number)
    except TypeError:
        count = -1
    if not 0 <= count < 2**63:  # what a row can hold
        raise TypeError(
            f"{name} returned {number!r} ({type(number).__name__}); expected a whole number from 0 to 2**63 - 1"
        )
    return count


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


def _flat(actions: list[Any]) -> tuple[float, ...]:
    return tuple(float(x) for action in actions for x in (action if isinstance(action, tuple) else (action,)))


def _episode(
    scenario: Scenario,
    variant: Variant,
    entry: Entry,
    episode: int,
    workers: int,
    record: Record,
    judge: GridJudge | None,
) -> Episode:
    return Episode(
        scenario=scenario.name,
        variant=variant.name,
        agent=entry.label,
        episode=episode,
        outcome=record.outcome.name,
        steps=len(record.actions),
        length=record.length,
        judged=judge.judged if judge else 0,
        wrong_decisions=judge.wrong if judge else 0,
        strict_wrong=judge.strict_wrong if judge else 0,
        setup_seconds=record.setup_seconds,
        decision_seconds=tuple(record.decision_seconds),
        peak_memory_bytes=record.peak_memory_bytes,
        parameter_bytes=record.parameter_bytes,
        search_nodes=record.search_nodes,
        actions=_flat(record.actions),
        detail=record.detail,
        workers=workers,
        agent_key=agent_key(entry),
        world_key=world_key(variant),
        **_facts(variant, episode),
    )
