"""What every plug-in of the tables is tested with: examples of its settings, and worlds to play in.

A new agent or map family needs a line in `AGENTS` or `FAMILIES` here; then all contracts are tested for it. What
`tests/plugin/ring_kind` adds, a kind of world of another package, keeps the same ones.
"""

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib.metadata import Distribution
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from pkgutil import resolve_name
from typing import Any, NamedTuple

import networkx as nx
import numpy as np
import pytest
import torch
from PIL import Image

from fogbench import learned, planners, worlds
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.tables import named, registered
from fogbench.worlds.types import AgentSettings, MapFamily, Observation, Task, World

AGENTS: dict[str, list[dict[str, Any]]] = {
    "astar": [{}, {"replan": "change"}],
    "memoryless": [{}],
    "dstar_lite": [{}],
    "frontier": [{}],
    "rrt_star": [{"iterations": 200}, {"planner": "RRTConnect", "iterations": 200, "space": "se2"}],
    "hfn": [{}],
    "random_walk": [{}],
    "breadth_first": [{}],
    "nearest_unvisited": [{}],
    "macn": [
        {"checkpoint": "none"},
        {"checkpoint": "none", "reads": 1, "writes": 2, "memory_rows": 7, "links": False, "discount": 0.9},
        {"checkpoint": "none", "memory": "lstm", "seed": 1},
        {"checkpoint": "none", "memory": "feedforward", "stitched": True},
        {"checkpoint": "none", "reading": "map", "size": [14, 14]},
    ],
    "vin": [{"checkpoint": "none"}, {"checkpoint": "none", "stitched": True, "reading": "map", "size": [14, 14]}],
    "macn_graph": [
        {"checkpoint": "none", "nodes": 36, "reads": 1, "writes": 4},
        {"checkpoint": "none", "nodes": 36, "memory": "lstm"},
    ],
    "vin_graph": [{"checkpoint": "none", "nodes": 36}, {"checkpoint": "none", "nodes": 36, "discount": 0.9}],
    "cnn_memory_graph": [
        {"checkpoint": "none", "nodes": 36, "features": None},
        {"checkpoint": "none", "nodes": 36, "memory": "lstm"},
    ],
    "macn_explored": [{"checkpoint": "none"}, {"checkpoint": "none", "memory": "feedforward", "most": 40}],
    "macn_robot": [{"checkpoint": "none"}, {"checkpoint": "none", "memory": "lstm", "masked": True}],
    "vin_robot": [{"checkpoint": "none"}],
    "cnn_memory_robot": [{"checkpoint": "none", "memory": "gru"}],
    "cnn_memory": [{"checkpoint": "none", "memory": "gru"}, {"checkpoint": "none", "memory": "lstm", "size": [7, 9]}],
    "walker": [{}],
    "ring_net": [{"checkpoint": "none"}],
}
"""Settings of every agent that ships, or that the foreign package adds, fast to play."""

WAXMAN = {"generator": "waxman_graph", "parameters": {"beta": 0.9, "alpha": 0.15, "domain": [0, 0, 20, 20]}}
"""Graphs whose nodes have coordinates and whose edges are as long as the line between them."""

FAMILIES: dict[str, list[dict[str, Any]]] = {
    "blobs": [
        {"size": 12, "obstacles": [5, 15], "obstacle_size": [1, 3]},
        {"size": 12, "obstacles": [5, 16], "obstacle_size": [1, 3]},
    ],
    "fixed_blobs": [
        {"size": 12, "obstacles": [5, 15], "obstacle_size": [1, 3]},
        {"size": 12, "obstacles": [5, 15], "obstacle_size": [1, 3], "map_seed": 1},
    ],
    "tunnel": [{"length": [4, 9]}, {"length": [10, 12], "width": 3, "bends": [0, 1], "open": 0.5, "goal": "inside"}],
    "maze": [{"size": 11}, {"size": 11, "loops": 0.2}],
    "rooms": [{"size": 15, "rooms": [2, 3], "doors": [1, 2]}, {"size": 15, "rooms": [2, 3], "doors": [1, 1]}],
    "bug_trap": [
        {"size": 14, "depth": [3, 6], "width": [3, 5]},
        {"size": 14, "depth": [3, 6], "width": [3, 5], "lip": [0, 1]},
    ],
    "movingai": [{"map": "one.map"}, {"map": "two.map"}, {"map": "one.map", "scen": "two.map.scen"}],
    "occupancy": [{"map": "one.yaml"}, {"map": "two.yaml"}, {"map": "one.yaml", "downsample": 2}],
    "random_graph": [
        {"nodes": 40, "mean_degree": 2.5},
        {"nodes": 40, "density": 0.06},
        {"nodes": 40, **WAXMAN},
        {"generator": "grid_2d_graph", "parameters": {"m": 5, "n": 8}},
    ],
    "fixed_graph": [
        {"nodes": 40, "mean_degree": 2.5},
        {"nodes": 40, "mean_degree": 2.5, "number": 1},
        {"nodes": 40, "mean_degree": 2.5, "pairs": "training"},
    ],
    "graph_file": [{"file": "one.graphml"}, {"file": "one.graphml", "both_ways": True}, {"file": "two.edgelist"}],
    "stations": [{"size": 21}, {"size": 21, "cut": 0.7}],
}
"""The same of every map family, all different; files are those of the fixture `folder`."""

PLUGINS = Path(__file__).parents[1] / "plugin"

FOREIGN = {
    group: {point.name: point.value for point in points}
    for group, points in groupby(Distribution.at(PLUGINS / "ring_kind-1.0.dist-info").entry_points, attrgetter("group"))
}
"""What the foreign package adds, by the group of entry points."""

ARENAS: dict[str, list[tuple[str, dict[str, Any], dict[str, Any]]]] = {
    "grid": [
        ("blobs", {"size": 14, "obstacles": [10, 20], "obstacle_size": [1, 3]}, {"radius": 1}),
        ("rooms", {"size": 15, "rooms": [2, 3], "doors": [1, 2]}, {"radius": 3, "occlusion": True}),
        ("maze", {"size": 11, "loops": 0.1}, {"radius": 2, "occlusion": True, "slip": 0.2}),
        ("bug_trap", {"size": 14, "depth": [4, 7], "width": [3, 5]}, {"radius": 2}),
        ("tunnel", {"length": [6, 9]}, {"radius": 2, "collision": "blocked", "slip": 0.2, "slip_to": "sideways"}),
        (
            "blobs",
            {"size": 14, "obstacles": [10, 20], "obstacle_size": [1, 3]},
            {"radius": 2, "occlusion": True, "false_readings": 0.1, "collision": "blocked", "slip": 0.1},
        ),
    ],
    "graph": [
        ("random_graph", {"nodes": 36, "mean_degree": 2.5}, {}),
        ("random_graph", {"nodes": 36, **WAXMAN}, {"slip": 0.2}),
        ("random_graph", {"generator": "grid_2d_graph", "parameters": {"m": 4, "n": 9}}, {}),
        ("fixed_graph", {"nodes": 36, "mean_degree": 2.5}, {"slip": 0.2}),
    ],
    "robot": [
        ("blobs", {"size": 90, "obstacles": [8, 14], "obstacle_size": [3, 12]}, {"sensor": {"beams": 90}}),
        ("maze", {"size": 9}, {"walls": {"cell": 1.0, "split": 10}, "rules": {"physics": "unicycle"}}),
        (
            "blobs",
            {"size": 90, "obstacles": [8, 14], "obstacle_size": [3, 12]},
            {
                "sensor": {"beams": 60, "range": 4.0, "noise": 0.02, "dropped": 0.05},
                "rules": {"collision": "blocked", "physics": "unicycle"},
                "tasks": {"clearance": 0.4},
            },
        ),
    ],
    "ring": [("stations", {"size": 21, "cut": 0.7}, {"slip": slip}) for slip in (0.0, 0.2)],
}
"""Where agents are tested, by the kind of world: families, their settings, and the fields of the conditions."""

TERMS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "grid": ({"radius": 3}, {"radius": 2, "occlusion": True, "collision": "blocked"}),
    "graph": ({}, {"slip": 0.2}),
    "ring": ({}, {"slip": 0.2}),
}
"""Fields of the conditions that families are tested under, by the kind of world."""

BLOCKS = {"graph": "rules", "ring": "track"}
"""The block that has these fields, by the kind of world; those of grids are in several."""

EPISODES = 3
"""Worlds of each arena."""


class Decision(NamedTuple):
    """One decision of an episode, and what the agent said of itself after it."""

    agent: Any
    observation: Observation
    action: Any
    memory_bytes: int
    search_nodes: int


def decide(world: World, settings: AgentSettings, seed: int) -> Iterator[Decision]:
    """Play an episode, decision by decision."""
    luck, own = (np.random.default_rng([seed, purpose]) for purpose in (0, 1))
    agent, state = settings.start(world.task, own), world.reset()
    for _ in range(world.task.budget.steps):
        observation = world.sense(state, luck)
        action = agent.act(observation)
        yield Decision(agent, observation, action, agent.memory_bytes(), agent.search_nodes())
        if action is None:
            return
        step = world.step(state, action, luck)
        if step.reached or step.collided:
            return
        state = step.state


@pytest.fixture(autouse=True)
def _one_thread() -> Iterator[None]:
    """Networks run as in a worker process."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(before)


@pytest.fixture
def play() -> Callable[..., Iterator[Decision]]:
    """Plays an episode of a world, an agent's settings and a seed, decision by decision."""
    return decide


POLICIES = {**learned.LEARNED, **FOREIGN["fogbench.learned"]}
MAPS = {**worlds.FAMILIES, **FOREIGN["fogbench.families"]}
SHOWN = [*learned.ENCODINGS, *FOREIGN["fogbench.encodings"]]
EXAMPLES = {**AGENTS, **FAMILIES}
TABLES = {**planners.PLANNERS, **learned.LEARNED, **FOREIGN["fogbench.planners"], **POLICIES, **MAPS}


def of_grids(table: Mapping[str, str]) -> dict[str, str]:
    """The entries of a table that are about cells."""
    return {entry: target for entry, target in table.items() if "grid" in resolve_name(target).kinds}


SETTINGS = {
    "agent": {entry: TABLES[entry] for entry in TABLES if entry not in MAPS},
    "policy": POLICIES,
    "family": MAPS,
    "settings": TABLES,
    "grid_planner": of_grids(planners.PLANNERS),
    "grid_family": of_grids(worlds.FAMILIES),
}
"""The entries whose examples a test runs for, by the name of its argument; what is about cells takes those of grids."""

TEACHERS = {**planners.JUDGES, **FOREIGN["fogbench.judges"]}
"""What knows which actions are right, by the kind of world; that of robots teaches, and does not judge."""

NAMES = {
    "refereed": [*planners.REFERENCES, *FOREIGN["fogbench.references"]],
    "taught": [*TEACHERS],
    "judged": [kind for kind in TEACHERS if kind != "robot"],
    "shown": SHOWN,
    "family_name": [*MAPS],
}
"""What a test runs for by name: kinds of world that have a reference, a teacher, a judge, an encoding; and families."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test for all examples of all entries, or for all names, that it asks for."""
    for name in {*SETTINGS} & {*metafunc.fixturenames}:
        entries = [(entry, number) for entry in SETTINGS[name] for number in range(len(EXAMPLES.get(entry, [{}])))]
        metafunc.parametrize(name, entries, indirect=True, ids=[f"{entry}-{number}" for entry, number in entries])
    for name in {*NAMES} & {*metafunc.fixturenames}:
        metafunc.parametrize(name, NAMES[name])


@pytest.fixture(autouse=True, scope="module")
def _installed() -> Iterator[None]:
    """The foreign package is on the path, and found by its entry points."""
    sys.path.append(str(PLUGINS))
    registered.cache_clear()
    yield
    sys.path.remove(str(PLUGINS))
    registered.cache_clear()


@pytest.fixture
def examples(folder: Path) -> Callable[[str], list[Any]]:
    """Makes all examples of an entry."""

    def make(entry: str) -> list[Any]:
        assert entry in EXAMPLES, f"the tables have {entry}; expected examples of its settings in {__file__}"
        made = resolve_name(TABLES[entry])
        return [made.model_validate(fields, context={"folder": folder}) for fields in EXAMPLES[entry]]

    return make


@pytest.fixture
def settings(request: pytest.FixtureRequest, examples: Callable[[str], list[Any]]) -> Any:
    """An example of an entry."""
    entry, number = request.param
    return examples(entry)[number]


agent = policy = family = grid_planner = grid_family = settings
"""The same, of some of the entries."""


@pytest.fixture
def under(conditions: Callable[..., Any]) -> Callable[..., Any]:
    """Makes conditions of a kind of their fields: of robots the blocks, of others the fields of all blocks in one."""

    def make(kind: str, steps: Any = 40, distance: Any = None, **fields: Any) -> Any:
        if kind == "grid":
            return conditions(steps=steps, distance=distance, **fields)
        if kind == "robot":
            tasks = {"distance": distance, **fields.pop("tasks", {})}
            return RobotConditions.model_validate({**fields, "tasks": tasks, "budget": {"steps": steps}})
        made = resolve_name(named(worlds.KINDS, "fogbench.kinds", kind).conditions)
        return made(**{BLOCKS[kind]: fields}, tasks={"distance": distance}, budget={"steps": steps})

    return make


@pytest.fixture
def sampled(under: Callable[..., Any]) -> Callable[[MapFamily], list[World]]:
    """Draws eight worlds of a family within 40 steps, and eight whose optimum is 4 to 20."""

    def draw(family: MapFamily) -> list[World]:
        kind = family.kinds[0]
        plain, other = TERMS[kind]
        bounds = {"steps": {"per_distance": 3, "plus": 5}, "distance": (4, 20)}
        return [
            family.sample(np.random.default_rng([seed, 7]), seed, conditions)
            for conditions in (under(kind, **plain), under(kind, **bounds, **other))
            for seed in range(8)
        ]

    return draw


@pytest.fixture
def arena(under: Callable[..., Any]) -> Callable[[str], list[World]]:
    """Draws worlds of a kind, a few from each arena."""

    def draw(kind: str) -> list[World]:
        assert kind in ARENAS, f"the tables have {kind}; expected worlds for it in {__file__}"
        drawn = []
        for family, fields, rules in ARENAS[kind]:
            maps, conditions = resolve_name(TABLES[family])(**fields), under(kind, distance=(5, 30), **rules)
            drawn += [maps.sample(np.random.default_rng(seed), seed, conditions) for seed in range(EPISODES)]
        return drawn

    return draw


@pytest.fixture
def meetings(agent: AgentSettings, arena: Callable[[str], list[World]]) -> list[World]:
    """Worlds of all the kinds that an agent plays, a few from each arena."""
    found = [world for kind in agent.kinds for world in arena(kind)]
    if getattr(agent, "reading", "") == "map":  # made for maps of one size
        found = [world for world in found if world.task.extent == agent.size]
    assert len(found) > 1
    return found


class Numbered:
    """Stands in for the encoding of a kind that has none: an output is a recorded number, a viewpoint keeps nothing."""

    def __init__(self, world: World) -> None:
        """One output for each node of a world, as large as all others."""
        self.world = world
        self.outputs = tuple(map(str, range(int(world.task.extent[0]))))

    def start(self, task: Task) -> "Numbered":
        """A viewpoint."""
        assert task.extent == self.world.task.extent
        return self

    def see(self, observation: Observation) -> None:
        """Nothing is kept."""

    def act(self, output: int) -> Any:
        """The action of a number."""
        return self.world.action(output)

    def encode(self, viewpoints: Sequence["Numbered"]) -> tuple[()]:
        """There is no network to be shown anything."""
        return ()


@pytest.fixture
def encoding_of(arena: Callable[[str], list[World]]) -> Callable[[str], Any]:
    """The encoding of a kind, as the first learned agent that plays it is shown its worlds."""

    def find(kind: str) -> Any:
        if kind not in SHOWN:
            return Numbered(arena(kind)[0])
        made = [(resolve_name(target), AGENTS[name][0]) for name, target in POLICIES.items()]
        shown = [policy.model_validate(fields).encoding() for policy, fields in made if kind in policy.kinds]
        assert shown, f"no learned agent plays {kind}"
        return shown[0]

    return find


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two small maps and graphs, `one` and `two`, in the formats of all families that read files."""
    place = tmp_path_factory.mktemp("maps")
    for seed, name in enumerate(("one", "two")):
        rng = np.random.default_rng(seed)
        blocked = rng.random((16, 20)) < 0.15  # [H, W]
        free = np.argwhere(~blocked)
        _write_movingai(place / f"{name}.map", blocked, rng.choice(free, size=(40, 2)))
        _write_occupancy(place / f"{name}.yaml", blocked)
        _write_graph(place / name, seed)
    return place


def _write_graph(path: Path, seed: int) -> None:
    graph = nx.waxman_graph(60, beta=0.7, alpha=0.2, domain=(0, 0, 20, 20), seed=seed)
    assert nx.is_connected(graph)
    nx.write_edgelist(graph, path.with_suffix(".edgelist"), data=False)
    for _, place in graph.nodes(data=True):
        place["x"], place["y"] = place.pop("pos")
    nx.write_graphml(graph, path.with_suffix(".graphml"))


def _write_movingai(path: Path, blocked: Any, ends: Any) -> None:
    height, width = blocked.shape
    rows = "\n".join("".join(row) for row in np.where(blocked, "@", "."))
    path.write_text(f"type octile\nheight {height}\nwidth {width}\nmap\n{rows}\n")
    lines = [f"0\tone.map\t{width}\t{height}\t{a[1]}\t{a[0]}\t{b[1]}\t{b[0]}\t9.0" for a, b in ends]
    path.with_name(f"{path.name}.scen").write_text("\n".join(["version 1", *lines]) + "\n")


def _write_occupancy(path: Path, blocked: Any) -> None:
    Image.fromarray(np.where(blocked, 0, 254).astype(np.uint8)).save(path.with_suffix(".pgm"))
    numbers = "resolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    path.write_text(f"image: {path.stem}.pgm\n{numbers}")
