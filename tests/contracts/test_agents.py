"""The contract of every agent of the table, in every kind of world it plays."""

from collections.abc import Callable
from itertools import pairwise, zip_longest
from typing import Any

import numpy as np

from fogbench.worlds import KINDS
from fogbench.worlds.tables import named
from fogbench.worlds.types import AgentSettings, Move, World

Play = Callable[..., Any]

ACTIONS = {"grid": "Move", "graph": "int", "robot": "Waypoint", "ring": "Way"}
"""The type of what an agent may answer, besides None, by the kind of world."""


def facts(decisions: Any) -> list[Any]:
    """What must be equal where episodes are equal."""
    return [(d.observation.place, d.action, d.memory_bytes, d.search_nodes) for d in decisions]


def test_kinds_exist(agent: AgentSettings) -> None:
    """An agent plays one kind of world at least, and none that there is not."""
    assert agent.kinds
    assert all(named(KINDS, "fogbench.kinds", kind) for kind in agent.kinds)


def test_answers_are_of_the_right_type(agent: AgentSettings, meetings: list[World], play: Play) -> None:
    """An action of the kind or None; counts are whole numbers from 0; search effort never shrinks."""
    assert type(agent.parameter_bytes()) is int
    assert agent.parameter_bytes() >= 0
    for seed, world in enumerate(meetings):
        decisions = list(play(world, agent, seed))
        for decision in decisions:
            assert decision.action is None or type(decision.action).__name__ == ACTIONS[world.task.kind]
            assert type(decision.memory_bytes) is type(decision.search_nodes) is int
            assert min(decision.memory_bytes, decision.search_nodes) >= 0
        assert all(a.search_nodes <= b.search_nodes for a, b in pairwise(decisions))


def test_the_same_luck_gives_the_same_episode(agent: AgentSettings, meetings: list[World], play: Play) -> None:
    """Actions, bytes and effort follow from the world and the agent's own generator, and from nothing else."""
    for seed, world in enumerate(meetings):
        first = facts(play(world, agent, seed))
        np.random.seed(seed)  # noqa: NPY002  an agent that draws from it would be found out here
        assert facts(play(world, agent, seed)) == first


def test_agents_are_independent(agent: AgentSettings, meetings: list[World], play: Play) -> None:
    """Two agents of the same settings that decide in turns, in two worlds, decide as each does alone."""
    for seed, (here, there) in enumerate(zip(meetings[::2], meetings[1::2], strict=False)):
        alone = facts(play(here, agent, seed)), facts(play(there, agent, seed + 1))
        turns = list(zip_longest(play(here, agent, seed), play(there, agent, seed + 1)))
        together = [facts(decision for decision in side if decision) for side in zip(*turns, strict=True)]
        assert tuple(together) == alone


def test_observations_are_left_alone(agent: AgentSettings, meetings: list[World]) -> None:
    """What an agent was shown is after its decision what it was before, and still read-only."""
    for seed, world in enumerate(meetings):
        decider = agent.start(world.task, np.random.default_rng(seed))
        observation = world.sense(world.reset(), np.random.default_rng(seed))
        before = observation._replace(view=observation.view.copy())
        decider.act(observation)
        assert observation._replace(view=None) == before._replace(view=None)
        assert np.array_equal(observation.view, before.view)
        assert not observation.view.flags.writeable


def test_a_goal_next_door_is_reached(grid_planner: AgentSettings, draw: Callable[..., World], play: Play) -> None:
    """In a map of two cells every planner takes the one move that there is."""
    assert [decision.action for decision in play(draw("SG"), grid_planner, 0)] == [Move.RIGHT]
    assert [decision.action for decision in play(draw("S\nG"), grid_planner, 0)] == [Move.DOWN]
    assert [decision.action for decision in play(draw("GS"), grid_planner, 0)] == [Move.LEFT]
    assert [decision.action for decision in play(draw("G\nS"), grid_planner, 0)] == [Move.UP]
