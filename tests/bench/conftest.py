"""What the tests of the harness share: a small scenario, and agents that misbehave."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import yaml

from fogbench.bench.reading.scenario import Scenario, read_scenario

Make = Callable[..., Scenario]

SMALL = {
    "name": "small",
    "about": "Two variants on maps of 6x6 cells.",
    "maps": {"blobs": {"size": 6, "obstacles": [2, 6], "obstacle_size": [1, 2]}},
    "sensor": {"radius": 1},
    "tasks": {"distance": [1, 10]},
    "variants": {"short": {"budget": {"steps": 6}}, "long": {"budget": {"steps": 30}}},
    "agents": ["astar", "memoryless", "random_walk"],
    "reference": "astar",
    "episodes": 4,
    "seed": 0,
}

BAD = '''
import os, signal, time
from typing import ClassVar, Literal

import numpy as np

from fogbench.planners.astar import AStarAgent
from fogbench.worlds.settings import Settings


class Bad(Settings):
    """A* that does its worst at its third decision, or when it starts."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})
    how: str

    def start(self, task, rng):
        if self.how == "start":
            raise RuntimeError("no start")
        return BadAgent(task, self.how)

    def parameter_bytes(self):
        return 0


class BadAgent(AStarAgent):
    def __init__(self, task, how):
        super().__init__(task, eager=False)
        self.how, self.now = how, False

    def act(self, observation):
        self.now = observation.step == 2
        if not self.now:
            return super().act(observation)
        if self.how == "act":
            raise ValueError("no\\n  act")
        if self.how == "exit":
            os._exit(3)
        if self.how == "segfault":
            os.kill(os.getpid(), signal.SIGSEGV)
        if self.how == "sleep":
            time.sleep(3600)
        if self.how == "nonsense":
            return "north"
        return super().act(observation)

    def memory_bytes(self):
        if self.how == "memory" and self.now:
            raise LookupError("no count")
        return 10**9 if self.how == "hog" and self.now else super().memory_bytes()
'''
"""A plug-in that fails in the way its setting names."""


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """Writes the small scenario, with changes, to `tmp_path/small.yaml`, and `bad.py` beside it; reads it."""
    (tmp_path / "bad.py").write_text(BAD)

    def make(**changes: Any) -> Scenario:
        path = tmp_path / "small.yaml"
        path.write_text(yaml.safe_dump({**SMALL, **changes}, sort_keys=False))
        return read_scenario(path.read_text(), path)

    return make


SUCCESS = {
    "variant": "short",
    "kind": "grid",
    "agent": "astar",
    "outcome": "REACHED",
    "steps": 4,
    "budget_steps": 6,
    "length": 4.0,
    "shortest": 4.0,
    "reference_length": 4.0,
    "judged": 4,
    "wrong_decisions": 0,
    "strict_wrong": 0,
    "setup_seconds": 0.001,
    "decision_seconds": (0.001, 0.002, 0.003, 0.004),
    "peak_memory_bytes": 100,
    "search_nodes": 10,
    "detail": "",
    "world_key": "world",
}
"""What a report reads of an episode of A*."""


@pytest.fixture
def recorded() -> Callable[..., pd.DataFrame]:
    """Makes a table of episodes; each row says what differs from a success of A* in a few steps."""

    def recorded(*rows: dict[str, Any]) -> pd.DataFrame:
        table = pd.DataFrame([{**SUCCESS, "episode": k, **row} for k, row in enumerate(rows)])
        return table.astype({"reference_length": float})

    return recorded
