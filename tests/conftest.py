"""What all tests share.

A skipped test is a failure. Tests of real maps carry the marker `maps`. Small worlds are drawn as text.
"""

import os
from collections.abc import Callable, Generator
from typing import Any, ClassVar, TypeVar

import networkx as nx
import numpy as np
import pytest
from hypothesis import settings

from fogbench.worlds.conditions import BudgetSettings
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.networks import converted
from fogbench.worlds.graph.world import GraphWorld
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


@pytest.fixture(scope="session")
def on() -> Callable[..., GraphWorld]:
    """Makes the world of a task on a graph of networkx whose nodes are numbers from 0, and fields of the conditions."""

    def make(source: Any, start: int, goal: int, steps: Any = 100, slip: float = 0.0, distance: Any = None) -> Any:
        block = {"rules": {"slip": slip}, "budget": {"steps": steps}, "tasks": {"distance": distance}}
        ordered: Any = nx.Graph(**source.graph)
        ordered.add_nodes_from(sorted(source.nodes(data=True)))
        ordered.add_edges_from(source.edges(data=True))
        return GraphConditions.model_validate(block).world(converted(ordered).graph, start, goal)

    return make


@pytest.fixture(scope="session")
def weave() -> Callable[..., Any]:
    """Makes a connected graph of networkx of 2 to `most` nodes, a tree and more edges.

    The form `unit` has nothing else; `lengths` has whole numbers of which many are equal; `coordinates` has nodes
    on the crossings of a square, and edges that are straight, or longer by half.
    """

    def make(rng: np.random.Generator, form: str, most: int = 12) -> Any:
        size = int(rng.integers(2, most + 1))
        graph: Any = nx.empty_graph(size)
        graph.add_edges_from((node, int(rng.integers(node))) for node in range(1, size))
        more = rng.integers(size, size=(int(rng.integers(size + 1)), 2)).tolist()
        graph.add_edges_from((a, b) for a, b in more if a != b)
        if form == "lengths":
            nx.set_edge_attributes(graph, {edge: int(rng.integers(1, 4)) for edge in graph.edges}, "length")
        if form == "coordinates":
            side = int(np.ceil(np.sqrt(size)))
            for node, place in enumerate(rng.permutation(side**2)[:size].tolist()):
                graph.nodes[node]["x"], graph.nodes[node]["y"] = divmod(place, side)
            for a, b, edge in graph.edges(data=True):
                ends = [(graph.nodes[node]["x"], graph.nodes[node]["y"]) for node in (a, b)]
                edge["length"] = float(np.hypot(*np.subtract(*ends)) * rng.choice([1, 1, 1.5]))
        return graph

    return make


class Notes:
    """A plain record of what an agent has seen of a graph, kept by networkx."""

    def __init__(self) -> None:
        """Nothing was seen yet."""
        self.graph: Any = nx.Graph()
        self.visited: set[int] = set()

    def see(self, observation: Any) -> None:
        """Write down the edges in view."""
        self.visited.add(observation.place)
        self.graph.add_node(observation.place)
        for node, length in enumerate(observation.view[:, 0].tolist()):
            if np.isfinite(length):
                self.graph.add_edge(observation.place, node, length=length)


@pytest.fixture
def notes() -> type[Notes]:
    """Keeps the plain record of an episode."""
    return Notes
