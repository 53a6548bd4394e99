"""What all tests share.

A skipped test is a failure. Tests of real maps carry the marker `maps`. Small worlds are drawn as text.
"""

import os
from collections.abc import Callable, Generator
from typing import Any, ClassVar, TypeVar

import numpy as np
import pytest
from hypothesis import settings

from fogbench.worlds.conditions import BudgetSettings
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.rules import GridRules, SquareView
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import manhattan
from fogbench.worlds.maps.distances import distances
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import Array, Cell, Task

settings.register_profile("fogbench", derandomize=True, deadline=None, database=None)
settings.load_profile("fogbench")

LEFT_OUT = pytest.StashKey[int]()

Report = TypeVar("Report", pytest.TestReport, pytest.CollectReport)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Turn a skip into a failure."""
    report = yield
    return _failed(report)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Turn the skip of a whole file into a failure."""
    report = yield
    return _failed(report)


def _failed(report: Report) -> Report:
    if report.outcome == "skipped":
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr
        report.outcome = "failed"
        report.longrepr = f"{report.nodeid}: got a test that does not run ({reason}); expected one that runs"
    return report


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the tests of real maps where there are none."""
    if os.environ.get("FOGBENCH_MAPS"):
        return
    left_out = [item for item in items if item.get_closest_marker("maps")]
    items[:] = [item for item in items if not item.get_closest_marker("maps")]
    config.stash[LEFT_OUT] = len(left_out)
    config.hook.pytest_deselected(items=left_out)


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Say what was left out."""
    left_out = config.stash.get(LEFT_OUT, 0)
    if left_out:
        terminalreporter.write_line(f"FOGBENCH_MAPS is not set. Tests of real maps that were left out: {left_out}.")


class Picture(Settings):
    """A family of one world, drawn as text: `#` blocked, `S` start, `G` goal, `P` a post, all else free."""

    kinds: ClassVar[tuple[str, ...]] = ("grid",)

    rows: tuple[str, ...]

    def sample(self, rng: np.random.Generator, episode: int, conditions: GridConditions) -> GridWorld:
        """The world, whatever the episode."""
        letters = np.array([list(row) for row in self.rows])  # [H, W]
        blocked = letters == "#"
        blocked.setflags(write=False)
        start, goal = _only(letters == "S"), _only(letters == "G")
        budget = conditions.budget.over(manhattan(start, goal))
        task = Task("grid", goal, conditions.sensor, budget, blocked.shape)
        optimum = int(distances(blocked, start, goal)[goal])
        posts = frozenset(map(tuple, np.argwhere(letters == "P").tolist()))
        return GridWorld(blocked, start, task, conditions.rules, optimum, posts)

    def words(self) -> str:
        """The picture."""
        return self.model_dump_json()

    def tasks(self, conditions: GridConditions, most: int) -> int | None:
        """Any number."""
        return None

    def extent(self) -> Cell:
        """That of the picture."""
        return len(self.rows), len(self.rows[0])


def _only(letters: Array) -> Cell:
    ((row, column),) = np.argwhere(letters).tolist()
    return row, column


@pytest.fixture
def conditions() -> Callable[..., GridConditions]:
    """Makes grid conditions of the fields of all four blocks."""

    def make(steps: Any = 20, memory_bytes: int | None = None, distance: Any = None, **fields: Any) -> GridConditions:
        sensor = {name: fields.pop(name) for name in SquareView.model_fields if name in fields}
        return GridConditions(
            sensor=SquareView(**{"radius": 1, **sensor}),
            rules=GridRules(**fields),
            tasks={"distance": distance},
            budget=BudgetSettings(steps=steps, memory_bytes=memory_bytes),
        )

    return make


@pytest.fixture
def picture() -> Callable[[str], Picture]:
    """Makes a family of one world of a text, its rows apart by white space."""
    return lambda text: Picture(rows=tuple(text.split()))


@pytest.fixture
def draw(picture: Callable[[str], Picture], conditions: Callable[..., GridConditions]) -> Callable[..., GridWorld]:
    """Makes a grid world of a text and the fields of its conditions."""
    return lambda text, **fields: picture(text).sample(np.random.default_rng(0), 0, conditions(**fields))
