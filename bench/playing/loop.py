"""The episode loop: the only place that holds a world and an agent at once.

All that it imports decides, beside the world, the agent and the judge, what an episode is; keys of episodes cover it.
"""

from dataclasses import dataclass, field
from functools import lru_cache
from operator import index
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from fogbench.worlds.streams import stream
from fogbench.worlds.types import Agent, AgentSettings, Outcome, World

if TYPE_CHECKING:
    from fogbench.bench.reading.scenario import Variant


@dataclass(slots=True)
class Record:
    """What one agent did in one world, as it goes on, by the names of a row; see `Episode`."""

    outcome: Outcome = Outcome.CRASHED
    length: float = 0.0
    remaining: list[float] = field(default_factory=list)
    judged: int = 0
    wrong_decisions: int = 0
    strict_wrong: int = 0
    setup_seconds: float = 0.0
    decision_seconds: list[float] = field(default_factory=list)
    peak_memory_bytes: int = 0
    parameter_bytes: int = 0
    search_nodes: int = 0
    actions: list[Any] = field(default_factory=list)
    detail: str = ""


class ClerkError(Exception):
    """What stands beside an episode has failed, and not its agent; the text is one line."""


class Clerk:
    """Sits beside an episode, untimed: writes down how far the goal was, and what a judge says of each decision."""

    def __init__(self, world: World, judge: Any, record: Record) -> None:
        """Before the first decision; with no judge, or one that only teaches, no decision is judged."""
        self.world, self.record = world, record
        self.judge = judge if hasattr(judge, "judge") else None

    def stands(self, state: Any) -> None:
        """The agent decides in a state."""
        try:
            self.record.remaining.append(float(self.world.remaining(state)))
        except Exception as error:
            raise _told("the world, asked what remains to the goal", error) from error

    def decided(self, observation: Any, action: Any) -> None:
        """An action was carried out."""
        if self.judge is None:
            return
        try:
            self.judge.see(observation)
            judged, wrong, strictly_wrong = self.judge.judge(action)
        except Exception as error:
            raise _told("the judge", error) from error
        self.record.judged += bool(judged)
        self.record.wrong_decisions += bool(wrong)
        self.record.strict_wrong += bool(strictly_wrong)


def _told(who: str, error: Exception) -> ClerkError:
    return ClerkError(f"{who} raised {type(error).__name__}: {error}")


def roll(world: World, agent: Agent, luck: np.random.Generator, record: Record, clerk: Clerk | None) -> Outcome:
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
        if clerk is not None:
            clerk.stands(state)
        if action is None:
            return Outcome.GAVE_UP
        step = world.step(state, action, luck)
        if clerk is not None:
            clerk.decided(observation, action)
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
    world: World, settings: AgentSettings, variant: "Variant", episode: int, record: Record, clerk: Clerk | None
) -> None:
    """One bare episode, from the start of the agent, written into `record` as it goes on."""
    luck, own = (episode_stream(variant, purpose, episode) for purpose in ("luck", "agent"))
    record.parameter_bytes = _count(settings.parameter_bytes(), "parameter_bytes")
    began = perf_counter()
    agent = settings.start(world.task, own)
    record.setup_seconds = perf_counter() - began
    record.outcome = roll(world, agent, luck, record, clerk)
    record.search_nodes = _count(agent.search_nodes(), "search_nodes")


def episode_stream(variant: "Variant", purpose: str, episode: int) -> np.random.Generator:
    """Worlds that differ in their sensor or their rules alone are drawn from the same stream: they share their maps."""
    return stream(variant.seed, variant.family.words(), purpose, episode)


@lru_cache(maxsize=16)
def episode_world(variant: "Variant", episode: int) -> World:
    """The world of an episode; the last few are kept, for agents that meet the same one.

    Raises:
        MapError: the map family cannot make it.
    """
    return variant.family.sample(episode_stream(variant, "map", episode), episode, variant.conditions)


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
