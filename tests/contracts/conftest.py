"""What every plug-in of the tables is tested with: examples of its settings, and worlds to play in.

A new agent or map family needs a line in `AGENTS` or `FAMILIES` here; then all contracts are tested for it. Agents of
`tests/plugin/ring_kind`, a kind of world of another package, keep the same ones.
"""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from pkgutil import resolve_name
from typing import Any, NamedTuple

import numpy as np
import pytest
import torch
from PIL import Image

from fogbench import learned, planners, worlds
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.bug_trap import BugTrap
from fogbench.worlds.maps.families.maze import Maze
from fogbench.worlds.maps.families.rooms import Rooms
from fogbench.worlds.maps.families.tunnel import Tunnel
from fogbench.worlds.types import AgentSettings, MapFamily, Observation, World

AGENTS: dict[str, list[dict[str, Any]]] = {
    "astar": [{}, {"replan": "change"}],
    "memoryless": [{}],
    "dstar_lite": [{}],
    "frontier": [{}],
    "rrt_star": [{"iterations": 200}, {"planner": "RRTConnect", "iterations": 200}],
    "random_walk": [{}],
    "macn": [
        {"checkpoint": "none"},
        {"checkpoint": "none", "reads": 1, "writes": 2, "memory_rows": 7, "links": False, "discount": 0.9},
        {"checkpoint": "none", "memory": "lstm", "seed": 1},
        {"checkpoint": "none", "memory": "feedforward", "stitched": True},
        {"checkpoint": "none", "reading": "map", "size": [14, 14]},
    ],
    "vin": [{"checkpoint": "none"}, {"checkpoint": "none", "stitched": True, "reading": "map", "size": [14, 14]}],
    "cnn_memory": [{"checkpoint": "none"}, {"checkpoint": "none", "memory": "lstm", "size": [7, 9]}],
    "walker": [{}],
}
"""Settings of every entry of `fogbench.planners.PLANNERS`, `fogbench.learned.LEARNED` and `FOREIGN`, fast to play."""

FOREIGN = {"walker": "ring_kind.walker:Walker"}
"""Agents of a kind of world of another package."""

sys.path.append(str(Path(__file__).parents[1] / "plugin"))

FAMILIES: dict[str, list[dict[str, Any]]] = {
    "blobs": [
        {"size": 12, "obstacles": [5, 15], "obstacle_size": [1, 3]},
        {"size": 12, "obstacles": [5, 16], "obstacle_size": [1, 3]},
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
}
"""Settings of every entry of `fogbench.worlds.FAMILIES`, all different; files are those of the fixture `folder`."""

ARENAS: dict[str, list[tuple[MapFamily, dict[str, Any]]]] = {
    "grid": [
        (Blobs(size=14, obstacles=(10, 20), obstacle_size=(1, 3)), {"radius": 1}),
        (Rooms(size=15, rooms=(2, 3), doors=(1, 2)), {"radius": 3, "occlusion": True}),
        (Maze(size=11, loops=0.1), {"radius": 2, "occlusion": True, "slip": 0.2}),
        (BugTrap(size=14, depth=(4, 7), width=(3, 5)), {"radius": 2}),
        (Tunnel(length=(6, 9)), {"radius": 2, "collision": "blocked", "slip": 0.2, "slip_to": "sideways"}),
        (
            Blobs(size=14, obstacles=(10, 20), obstacle_size=(1, 3)),
            {"radius": 2, "occlusion": True, "false_readings": 0.1, "collision": "blocked", "slip": 0.1},
        ),
    ],
    "ring": [(resolve_name("ring_kind.stations:Stations")(size=21, cut=0.7), {"slip": slip}) for slip in (0.0, 0.2)],
}
"""Where agents are tested, by the kind of world: families, and the fields of the conditions."""

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


EXAMPLES = {**AGENTS, **FAMILIES}
OURS = {**planners.PLANNERS, **learned.LEARNED}
AGENT_TABLE = {**OURS, **FOREIGN}
TABLES = {**AGENT_TABLE, **worlds.FAMILIES}


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test for all examples of all entries of the table that it asks for."""
    tables = {
        "agent": OURS if metafunc.module.__name__.endswith("one_view") else AGENT_TABLE,  # rings have their own test
        "planner": planners.PLANNERS,
        "policy": learned.LEARNED,
        "family": worlds.FAMILIES,
        "settings": TABLES,
    }
    for name, table in tables.items():
        if name in metafunc.fixturenames:
            entries = [(entry, number) for entry in table for number in range(len(EXAMPLES.get(entry, [{}])))]
            metafunc.parametrize(name, entries, indirect=True, ids=[f"{entry}-{number}" for entry, number in entries])


@pytest.fixture
def examples(folder: Path) -> Callable[[str], list[Any]]:
    """Makes all examples of an entry, of either table."""

    def make(entry: str) -> list[Any]:
        assert entry in EXAMPLES, f"the tables have {entry}; expected examples of its settings in {__file__}"
        made = resolve_name(TABLES[entry])
        return [made.model_validate(fields, context={"folder": folder}) for fields in EXAMPLES[entry]]

    return make


@pytest.fixture
def settings(request: pytest.FixtureRequest, examples: Callable[[str], list[Any]]) -> Any:
    """An example of an entry of either table."""
    entry, number = request.param
    return examples(entry)[number]


agent = planner = policy = family = settings
"""The same, of one of the tables."""


@pytest.fixture
def arena(conditions: Callable[..., Any]) -> Callable[[str], list[World]]:
    """Draws worlds of a kind, a few from each arena."""

    def draw(kind: str) -> list[World]:
        assert kind in ARENAS, f"the tables have {kind}; expected worlds for it in {__file__}"
        make = {"grid": conditions, "ring": _ring_conditions}[kind]
        fields = [(maps, make(steps=40, distance=(5, 30), **fields)) for maps, fields in ARENAS[kind]]
        return [
            maps.sample(np.random.default_rng(seed), seed, under) for maps, under in fields for seed in range(EPISODES)
        ]

    return draw


def _ring_conditions(steps: int, distance: tuple[int, int], **fields: Any) -> Any:
    """Conditions of rings of the fields of their track."""
    made = resolve_name("ring_kind.conditions:RingConditions")
    return made(track=fields, tasks={"distance": distance}, budget={"steps": steps})


@pytest.fixture
def meetings(agent: AgentSettings, arena: Callable[[str], list[World]]) -> list[World]:
    """Worlds of all the kinds that an agent plays, a few from each arena."""
    found = [world for kind in agent.kinds for world in arena(kind)]
    if getattr(agent, "reading", "") == "map":  # made for maps of one size
        found = [world for world in found if world.task.extent == agent.size]
    assert len(found) > 1
    return found


@pytest.fixture
def encoding(kind: str) -> Any:
    """The encoding of a kind, as the first learned agent that plays it is shown its worlds."""
    made = [(resolve_name(target), AGENTS[name][0]) for name, target in learned.LEARNED.items()]
    shown = [policy.model_validate(fields).encoding() for policy, fields in made if kind in policy.kinds]
    assert shown, f"no learned agent plays {kind}"
    return shown[0]


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two small maps, `one` and `two`, in the formats of all families that read files."""
    place = tmp_path_factory.mktemp("maps")
    for seed, name in enumerate(("one", "two")):
        rng = np.random.default_rng(seed)
        blocked = rng.random((16, 20)) < 0.15  # [H, W]
        free = np.argwhere(~blocked)
        _write_movingai(place / f"{name}.map", blocked, rng.choice(free, size=(40, 2)))
        _write_occupancy(place / f"{name}.yaml", blocked)
    return place


def _write_movingai(path: Path, blocked: Any, ends: Any) -> None:
    height, width = blocked.shape
    rows = "\n".join("".join(row) for row in np.where(blocked, "@", "."))
    path.write_text(f"type octile\nheight {height}\nwidth {width}\nmap\n{rows}\n")
    lines = [f"0\tm.map\t{width}\t{height}\t{a[1]}\t{a[0]}\t{b[1]}\t{b[0]}\t9.0" for a, b in ends]
    path.with_name(f"{path.name}.scen").write_text("\n".join(["version 1", *lines]) + "\n")


def _write_occupancy(path: Path, blocked: Any) -> None:
    Image.fromarray(np.where(blocked, 0, 254).astype(np.uint8)).save(path.with_suffix(".pgm"))
    numbers = "resolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    path.write_text(f"image: {path.stem}.pgm\n{numbers}")
