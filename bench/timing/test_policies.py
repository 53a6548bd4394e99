"""One decision of every learned policy with fresh weights, on one thread, and MACN's beside its plain form.

    pytest bench/timing/test_policies.py -s

Plain is a decision by the equations: two convolutions to the reward map, value iteration, four convolutions beside it,
controller and memory access as they are written. In each round both take their turn, so that what else the machine
does falls on both.
"""

from collections.abc import Callable
from time import perf_counter
from typing import Any, cast

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture
from torch import Tensor

from fogbench.bench.reading.plugins import load
from fogbench.bench.reading.tables import AGENT
from fogbench.learned import LEARNED
from fogbench.learned.agent import PolicyAgent, weighted
from fogbench.learned.macn import Macn
from fogbench.learned.policy import Policy
from fogbench.learned.value_iteration import value_iteration as vi
from fogbench.worlds.conditions import BudgetSettings, Tasks
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.families.random_graph import RandomGraph
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.types import Observation

THREADS = 1
ROUNDS, DECISIONS = 100, 10
BUDGET = BudgetSettings(steps=40)
GRID = GridConditions(budget=BUDGET, tasks=Tasks(distance=(1, 40)))
WORLDS: dict[str, Any] = {
    "grid": Blobs(size=16, obstacles=(3, 12), obstacle_size=(1, 3)).sample(np.random.default_rng(0), 0, GRID),
    "graph": RandomGraph(nodes=16, mean_degree=3).sample(np.random.default_rng(0), 0, GraphConditions(budget=BUDGET)),
    "robot": Blobs(size=200, obstacles=(60, 60), obstacle_size=(5, 20)).sample(
        np.random.default_rng(0), 0, RobotConditions(budget=BUDGET)
    ),
}
PAPER = {"window": 200, "cell": 0.1, "iterations": 40, "hidden": 512, "memory_rows": 1024, "word": 512, "writes": 16}
SIZES: list[tuple[str, dict[str, Any]]] = [
    *((name, {}) for name in LEARNED),
    ("macn_robot", {"masked": True}),
    ("macn_robot", PAPER),
]
"""Policies with the settings that they are timed with; the last is the paper's robot."""

Decide = Callable[[], object]


def begun(policy: Policy) -> tuple[PolicyAgent, Observation]:
    """An agent that has decided once, and what it sees."""
    (kind,) = policy.kinds
    world, luck = WORLDS[kind], np.random.default_rng(0)
    agent, observation = cast(PolicyAgent, policy.start(world.task, luck)), world.sense(world.reset(), luck)
    agent.act(observation)
    return agent, observation


@pytest.mark.parametrize(("name", "fields"), SIZES, ids=[" ".join((name, *fields)) for name, fields in SIZES])
def test_decision(benchmark: BenchmarkFixture, name: str, fields: dict[str, Any]) -> None:
    """A decision of each policy, in a world of its kind."""
    benchmark.group = "decision, one thread"
    policy = cast(type[Policy], load(AGENT, name, LEARNED[name]))
    agent, observation = begun(policy(checkpoint="none", **fields))
    benchmark(agent.act, observation)


def test_ratio(monkeypatch: pytest.MonkeyPatch) -> None:
    """The share of the plain form's time that a decision of MACN takes, taking turns."""
    fast, observation = begun(Macn(checkpoint="none"))
    weighted.cache_clear()  # the plain form gets a network of its own
    plain, _ = begun(Macn(checkpoint="none"))
    network: Any = plain.network
    network.settled = network.memory.settled = None
    network.memory.fast = False
    planner = network.planner

    def planned(image: Tensor, barrier: Tensor | None = None) -> tuple[Tensor, Tensor]:
        reward = planner.reward_map.mix(planner.reward_map.features(image))
        return vi.plain(reward, planner.normalised(), planner.iterations, barrier)

    monkeypatch.setattr(planner, "forward", planned)
    turns = [lambda: plain.act(observation), lambda: fast.act(observation)]
    times = np.array([[seconds(turn) for turn in turns] for _ in range(ROUNDS + 2)])[2:]
    before, after = 1e6 * np.median(times, 0)
    ratio = np.median(times[:, 1] / times[:, 0])
    print(f"\none decision of MACN: plain {before:.0f} us, fast {after:.0f} us, {ratio:.2f} of the plain form's time")


def seconds(decide: Decide) -> float:
    """Seconds of one decision, of ten in a row."""
    began = perf_counter()
    for _ in range(DECISIONS):
        decide()
    return (perf_counter() - began) / DECISIONS
