"""The decisions of every planner in the table, and one long A* search."""

import os
from collections.abc import Iterator
from itertools import count, islice
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from fogbench.bench.playing.loop import Record, episode_stream, episode_world, start_and_roll
from fogbench.bench.playing.replay import retrace
from fogbench.bench.reading.plugins import load
from fogbench.bench.reading.scenario import read_scenario
from fogbench.bench.reading.tables import AGENT
from fogbench.bench.shipped import find
from fogbench.planners import PLANNERS
from fogbench.planners.astar import search
from fogbench.worlds.conditions import BudgetSettings, Tasks
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.movingai import MovingAI
from fogbench.worlds.types import BLOCKED, FREE, Agent, AgentSettings, Observation

GRID = find(["grid"])[0]
VARIANTS = read_scenario(GRID.read_text("utf-8"), GRID).variants
DENSE = next(variant for variant in VARIANTS if variant.name == "32x32 dense")
SETTINGS = {name: cast(type[AgentSettings], load(AGENT, name, target)) for name, target in PLANNERS.items()}

MAPS = os.environ.get("FOGBENCH_MAPS")
CITY = MovingAI(map=Path(MAPS, "movingai", "Boston_2_512.map")) if MAPS else None
BLOBS = Blobs(size=512, obstacles=(1500, 1500), obstacle_size=(1, 16))
LONG = GridConditions(tasks=Tasks(distance=(800, 10_000)), budget=BudgetSettings(steps=10_000))


@pytest.mark.parametrize("name", [name for name, settings in SETTINGS.items() if "grid" in settings.kinds])
def test_decision(benchmark: BenchmarkFixture, name: str) -> None:
    """The first decisions of a planner in dense 32x32 worlds, each timed once."""
    benchmark.group = "decision 32x32"
    ahead = decisions(SETTINGS[name]())
    benchmark.pedantic(  # type: ignore[no-untyped-call]  # pytest-benchmark says no types here
        lambda agent, observation: agent.act(observation), setup=lambda: (next(ahead), {}), rounds=300, warmup_rounds=1
    )


def decisions(settings: AgentSettings) -> Iterator[tuple[Agent, Observation]]:
    """An agent before each decision of its episodes, which were played once before to know what it will see."""
    for episode in count():
        world, record = episode_world(DENSE, episode), Record()
        start_and_roll(world, settings, DENSE, episode, record, None)
        agent = settings.start(world.task, episode_stream(DENSE, "agent", episode))
        row = {"episode": episode, "steps": len(record.actions), "actions": record.actions}
        for moment in islice(retrace(DENSE, row), len(record.actions)):
            yield agent, moment.observation


def test_search(benchmark: BenchmarkFixture) -> None:
    """A* over at least 800 cells of a fully known 512x512 map: a city's, or blobs where its file is not at hand."""
    family = CITY or BLOBS
    benchmark.group = f"A* 512x512 {type(family).__name__}"
    world = cast(GridWorld, family.sample(np.random.default_rng(0), 0, LONG))
    known = np.where(world.blocked, np.uint8(BLOCKED), np.uint8(FREE))  # [H, W]
    benchmark(search, known, world.start, world.task.goal)
