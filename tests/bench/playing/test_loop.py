"""The episode loop, held against episodes that were played by hand."""

import re
from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

from fogbench.bench.playing.episode import Episode
from fogbench.bench.playing.keys import agent_key, world_key
from fogbench.bench.playing.loop import episode_world
from fogbench.bench.playing.play import lost, play
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.reading.variant import Entry
from fogbench.planners.astar import AStar
from fogbench.planners.random_walk import RandomWalk
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import Move, Observation, Outcome, Task

D, R, U, L = Move

CORNER = "S.. .#. ..G"
"""Two ways around a wall, both four cells long."""


class UnreadableError(Exception):
    """An error that cannot even be printed."""

    def __str__(self) -> str:
        """Fail."""
        raise ValueError("no text")


ERRORS = {
    "plain": RuntimeError("no start"),
    "unreadable": UnreadableError(),
    "surrogate": ValueError("half of a pair: \ud800"),
    "long": ValueError("x" * 10**6),
}
"""What a script may raise at its start."""


class Script(Settings):
    """Answers what it was told to, and carries and counts what it was told to; the last value of each lasts."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    answers: tuple[Any, ...] = ()
    carries: tuple[Any, ...] = (0,)
    searched: Any = 0
    learned: Any = 0
    start_error: str = ""

    def start(self, task: Task, rng: np.random.Generator) -> "ScriptAgent":
        """An agent that reads the script from its beginning."""
        if self.start_error:
            raise ERRORS[self.start_error]
        return ScriptAgent(self)

    def parameter_bytes(self) -> Any:
        """As told."""
        return self.learned


class ScriptAgent:
    """One reading of a script."""

    def __init__(self, script: Script) -> None:
        """Begin."""
        self.script = script
        self.answers: Iterator[Any] = iter(script.answers)
        self.decisions = 0

    def act(self, observation: Observation) -> Any:
        """The next answer; the name of an error raises it."""
        assert observation.step == self.decisions
        self.decisions += 1
        answer = next(self.answers, None)
        if answer == "raise":
            raise ValueError("one\n  line")
        if answer == "exit":
            raise SystemExit(3)
        return answer

    def memory_bytes(self) -> Any:
        """The number of this decision."""
        return self.script.carries[min(self.decisions, len(self.script.carries)) - 1]

    def search_nodes(self) -> Any:
        """As told."""
        return self.script.searched


@pytest.fixture
def scenario(picture: Callable[[str], Any], conditions: Callable[..., Any]) -> Callable[..., Scenario]:
    """Makes a scenario of one variant: a picture or a family, agents, and the fields of the conditions."""

    def make(maps: Any, *agents: Any, **fields: Any) -> Scenario:
        family = picture(maps) if isinstance(maps, str) else maps
        entries = tuple(Entry(f"agent {n}", "", settings, "") for n, settings in enumerate(agents))
        variant = Variant("row", "grid", family, conditions(**fields), entries, "agent 0", episodes=100, seed=0)
        return Scenario(Path(), "", "hand-made", "", (variant,), {}, "")

    return make


def first(scenario: Scenario, agent: int = 0, episode: int = 0) -> Episode:
    """Play an episode of a scenario's variant."""
    (variant,) = scenario.variants
    return play(scenario, variant, variant.agents[agent], episode, workers=2)


def test_every_field_of_a_record(scenario: Callable[..., Scenario]) -> None:
    """An episode played by hand, and all that is written down about it."""
    script = Script(answers=(D, U, R, R, D, D), carries=(8, 100, 7), searched=12, learned=4096)
    made = scenario(CORNER, script, steps={"per_distance": 2, "plus": 1})
    row = first(made)
    expected = {
        "scenario": "hand-made",
        "variant": "row",
        "kind": "grid",
        "agent": "agent 0",
        "episode": 0,
        "outcome": "REACHED",
        "steps": 6,
        "budget_steps": 9,
        "length": 6.0,
        "straight": 4.0,
        "shortest": 4.0,
        "reference_length": 4.0,
        "judged": 6,
        "wrong_decisions": 1,  # back up
        "strict_wrong": 2,  # and to the right, where A* goes down
        "peak_memory_bytes": 100,
        "parameter_bytes": 4096,
        "search_nodes": 12,
        "actions": (0.0, 2.0, 1.0, 1.0, 0.0, 0.0),
        "detail": "",
        "remaining": (4.0, 3.0, 4.0, 3.0, 2.0, 1.0),
        "covariates": {"density": 1 - 8 / 9, "detour": 1.0, "dead_ends": 0.0, "openness": 24 / 64},
        "workers": 2,
        "agent_key": agent_key(made.variants[0].agents[0]),
        "world_key": world_key(made.variants[0]),
    }
    assert {name: getattr(row, name) for name in expected} == expected
    assert {field.name for field in fields(Episode)} - set(expected) == {"setup_seconds", "decision_seconds"}
    assert len(row.decision_seconds) == 6
    assert min(*row.decision_seconds, row.setup_seconds) > 0


@pytest.mark.parametrize(
    ("answers", "outcome", "steps", "length"),
    [
        ((R, R, D, D, "raise"), Outcome.REACHED, 4, 4.0),
        ((R, D, D), Outcome.COLLIDED, 2, 1.0),
        ((U, R, R), Outcome.COLLIDED, 1, 0.0),
        ((R, L, None, R), Outcome.GAVE_UP, 2, 2.0),
        ((None,), Outcome.GAVE_UP, 0, 0.0),
        ((R, L, R, L, R, L), Outcome.OUT_OF_STEPS, 5, 5.0),
    ],
)
def test_outcomes(
    scenario: Callable[..., Scenario], answers: tuple[Any, ...], outcome: Outcome, steps: int, length: float
) -> None:
    """Each way to end an episode of five steps; what is not carried out is no step, and nothing follows the end."""
    row = first(scenario(CORNER, Script(answers=answers), steps=5))
    assert (row.outcome, row.steps, row.length, row.detail) == (outcome.name, steps, length, "")
    assert len(row.actions) == steps
    assert len(row.decision_seconds) == len(row.remaining) == steps + (outcome is Outcome.GAVE_UP)


def test_a_blocked_move_is_a_step(scenario: Callable[..., Scenario]) -> None:
    """Where the rules say so, running into a wall costs a step and no length, and the episode goes on."""
    row = first(scenario(CORNER, Script(answers=(U, R, D, R, D, D)), collision="blocked"))
    assert (row.outcome, row.steps, row.length) == ("REACHED", 6, 4.0)


@pytest.mark.parametrize(
    ("answers", "steps", "outcome"),
    [
        ((R, R, D, D), 4, Outcome.REACHED),
        ((R, R, D, R), 4, Outcome.COLLIDED),
        ((R, R, D, None), 3, Outcome.OUT_OF_STEPS),
        ((R, R, D, None), 4, Outcome.GAVE_UP),
        ((R, R, D, U), 4, Outcome.OUT_OF_STEPS),
        ((R, R, D, U), 5, Outcome.OUT_OF_MEMORY),
    ],
)
def test_the_order_of_the_checks(
    scenario: Callable[..., Scenario], answers: tuple[Any, ...], steps: int, outcome: Outcome
) -> None:
    """What ends an episode in two ways at once has the first of them, in the order of `Outcome`."""
    script = Script(answers=answers, carries=(50, 50, 50, 51))
    assert first(scenario(CORNER, script, steps=steps, memory_bytes=50)).outcome == outcome.name


def test_the_order_of_outcomes_is_the_order_of_the_checks() -> None:
    """The table of outcomes says in which order they are looked for."""
    names = ["REACHED", "COLLIDED", "GAVE_UP", "OUT_OF_STEPS", "OUT_OF_MEMORY", "HUNG", "CRASHED"]
    assert [outcome.name for outcome in Outcome] == names


@pytest.mark.parametrize(("budget", "outcome", "steps"), [(99, "OUT_OF_MEMORY", 2), (100, "REACHED", 4)])
def test_a_memory_budget(scenario: Callable[..., Scenario], budget: int, outcome: str, steps: int) -> None:
    """As many bytes as the budget has may be carried; with one more the decision is the last."""
    script = Script(answers=(R, R, D, D), carries=(99, 100, 3))
    row = first(scenario(CORNER, script, memory_bytes=budget))
    assert (row.outcome, row.steps, row.peak_memory_bytes) == (outcome, steps, 100)


@pytest.mark.parametrize(
    ("script", "steps", "detail"),
    [
        ({"answers": (R, "raise")}, 1, "ValueError: one line (act, line "),
        ({"answers": (R, "exit")}, 1, "SystemExit: 3 (act, line "),
        ({"answers": (R, 7)}, 1, "TypeError: act returned 7 (int); expected a Move or None"),
        ({"start_error": "plain"}, 0, "RuntimeError: no start (start, line "),
        (
            {"answers": (R, R), "carries": (0, -1)},
            0,
            "TypeError: memory_bytes returned -1 (int); expected a whole number from 0 to 2**63 - 1",
        ),
        (
            {"answers": (R, R), "carries": (0, 2.0)},
            0,
            "TypeError: memory_bytes returned 2.0 (float); expected a whole number from 0 to 2**63 - 1",
        ),
        (
            {"answers": (R, None), "searched": 2**63},
            1,
            "TypeError: search_nodes returned 9223372036854775808 (int); expected a whole number from 0 to 2**63 - 1",
        ),
        (
            {"answers": (R, None), "searched": "many"},
            1,
            "TypeError: search_nodes returned 'many' (str); expected a whole number from 0 to 2**63 - 1",
        ),
        (
            {"answers": (R,), "learned": None},
            0,
            "TypeError: parameter_bytes returned None (NoneType); expected a whole number from 0 to 2**63 - 1",
        ),
    ],
)
def test_an_agent_that_fails_costs_its_episode(
    scenario: Callable[..., Scenario], script: dict[str, Any], steps: int, detail: str
) -> None:
    """Errors, an exit, and nonsense of any sort are an outcome with a sentence; what was done before is kept."""
    made = scenario(CORNER, Script(**script))
    row = first(made)
    assert row.outcome == "CRASHED"
    assert re.fullmatch(re.escape(detail) + (r"\d+\)" if detail.endswith("line ") else ""), row.detail)
    assert row.steps == steps or script.get("carries")
    assert (row.shortest, row.reference_length) == (4.0, 4.0)


@pytest.mark.parametrize(
    ("error", "detail"),
    [
        ("unreadable", "UnreadableError: no text"),
        ("surrogate", r"ValueError: half of a pair: \ud800"),
        ("long", f"ValueError: {'x' * 300}..."),
    ],
)
def test_any_error_of_an_agent_is_one_line_that_can_be_stored(
    scenario: Callable[..., Scenario], error: str, detail: str
) -> None:
    """Whatever its text is, or is not."""
    assert first(scenario(CORNER, Script(start_error=error))).detail.startswith(detail)


def test_a_lost_episode_has_the_facts_of_its_world(scenario: Callable[..., Scenario]) -> None:
    """An episode whose process hung or died says so, with no decisions, in the world that everybody met."""
    made = scenario(CORNER, Script(answers=(R,)))
    (variant,) = made.variants
    row = lost(made, variant, variant.agents[0], 3, 2, Outcome.HUNG, "no answer")
    assert (row.outcome, row.detail, row.episode, row.steps, row.judged) == ("HUNG", "no answer", 3, 0, 0)
    assert (row.actions, row.decision_seconds, row.peak_memory_bytes) == ((), (), 0)
    assert (row.shortest, row.straight, row.reference_length) == (4.0, 4.0, 4.0)


def test_a_reference_that_does_not_arrive_has_no_length(scenario: Callable[..., Scenario]) -> None:
    """Where A* on the map seen so far runs out of steps, there is no reference, and the optimum stays."""
    dead_end = "....... .#####. S...#.G .#####. ......."  # three cells in, three back, and ten around
    rows = [first(scenario(dead_end, Script(), steps=steps)) for steps in (15, 16)]
    assert [row.reference_length for row in rows] == [None, 16.0]
    assert [row.shortest for row in rows] == [10.0, 10.0]


@pytest.mark.parametrize("noise", [{}, {"false_readings": 0.1, "slip": 0.2, "collision": "blocked"}])
def test_the_reference_is_the_agent_a_star(scenario: Callable[..., Scenario], noise: dict[str, Any]) -> None:
    """`reference_length` is the length that A* itself travels in its own rows, and is the same in everybody's."""
    maps = Blobs(size=9, obstacles=(5, 12), obstacle_size=(1, 3))
    made = scenario(maps, AStar(), RandomWalk(), steps=14, **noise)
    reached = set()
    for episode in range(15):
        a_star, other = first(made, 0, episode), first(made, 1, episode)
        reached.add(a_star.outcome == "REACHED")
        assert a_star.reference_length == (a_star.length if a_star.outcome == "REACHED" else None)
        assert other.reference_length == a_star.reference_length
        assert (a_star.shortest, a_star.straight) == (other.shortest, other.straight)
    assert reached == {True, False}


def test_an_episode_is_the_same_whenever_it_is_played(scenario: Callable[..., Scenario]) -> None:
    """Neither what was played before nor who else plays changes an episode."""
    maps = Blobs(size=9, obstacles=(5, 12), obstacle_size=(1, 3))
    noise = {"false_readings": 0.1, "slip": 0.2, "collision": "blocked"}
    alone, together = scenario(maps, RandomWalk(), **noise), scenario(maps, RandomWalk(), AStar(), **noise)
    rows = [first(alone, 0, episode) for episode in range(4)]
    for episode in (3, 1, 0, 2):
        first(together, 1, episode)
        again = first(together, 0, episode)
        timings = {"setup_seconds", "decision_seconds"}
        for name in {field.name for field in fields(Episode)} - timings:
            assert getattr(again, name) == getattr(rows[episode], name), name


def test_sensors_and_rules_change_no_map(scenario: Callable[..., Scenario]) -> None:
    """Worlds that differ in what is seen, or in what a slip does, are drawn alike: their maps can be compared."""
    maps = Blobs(size=9, obstacles=(5, 12), obstacle_size=(1, 3))
    plain, noisy = (scenario(maps, AStar(), **noise).variants[0] for noise in ({}, {"slip": 0.2, "radius": 3}))
    for episode in range(3):
        one, other = episode_world(plain, episode), episode_world(noisy, episode)
        assert np.array_equal(one.blocked, other.blocked)
        assert (one.start, one.task.goal) == (other.start, other.task.goal)
