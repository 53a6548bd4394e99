"""The first promise: what an agent has not looked at cannot change what it does."""

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np

from fogbench.worlds.graph.graph import Graph, joined
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.sight import look
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.robot.world import RobotState, RobotWorld
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, AgentSettings, Cell, World


def other_grid(world: GridWorld, places: set[Cell], rng: np.random.Generator) -> tuple[GridWorld, int]:
    """A world that looks the same from all `places` and is different where it can be; and how many cells differ.

    A cell that was hidden may still have been looked at: had it been free, one behind it would have been in view. So a
    cell is changed, and changed back if any look shows it.
    """
    sensor, blocked = world.task.sensor, world.blocked.copy()  # [H, W]
    looks = {place: look(blocked, *place, sensor.radius, sensor.occlusion) for place in places}
    for cell in map(tuple, np.argwhere(rng.random(blocked.shape) < 0.5).tolist()):
        if cell in {world.start, world.task.goal}:
            continue
        blocked[cell] ^= True
        if any(not np.array_equal(look(blocked, *p, sensor.radius, sensor.occlusion), looks[p]) for p in places):
            blocked[cell] ^= True
    blocked.setflags(write=False)
    return replace(world, blocked=blocked), int(np.sum(blocked != world.blocked))


def other_ring(world: Any, places: set[int], rng: np.random.Generator) -> tuple[Any, int]:
    """The same of a ring, where an agent sees the two links of a station."""
    del rng
    links = world.links.copy()  # [N]
    seen = {(place - back) % len(links) for place in places for back in (0, 1)}
    for link in {*range(len(links))} - seen:
        links[link] = FREE + BLOCKED - links[link]
    links.setflags(write=False)
    return replace(world, links=links), len(links) - len(seen)


def other_graph(world: GraphWorld, places: set[int], rng: np.random.Generator) -> tuple[GraphWorld, int]:
    """The same of a graph: edges that touch no place are others, and nodes that were never in view lie elsewhere."""
    graph = world.graph
    rest = [node for node in range(graph.size) if node not in places]
    edges = {(a, b): length for a, b, length in edges_of(graph) if {a, b} & places}
    hidden = {(a, b): length for a, b, length in edges_of(graph) if not {a, b} & places}
    drawn = [pair for pair in combinations(rest, 2) if pair not in hidden and rng.random() < 0.1]
    edges |= {pair: float(rng.uniform(1, 30)) for pair in drawn} if not graph.unit else dict.fromkeys(drawn, 1.0)
    coordinates = graph.coordinates.copy()  # [N, 2]
    unseen = [*{*rest} - {node for place in places for node in graph.row(place).tolist()} - {world.task.goal}]
    coordinates[unseen] += 5
    other = joined(graph.size, np.array([*edges], np.int32), np.array([*edges.values()]), coordinates)
    return replace(world, graph=other), len(hidden) + len(drawn)


def edges_of(graph: Graph) -> list[tuple[int, int, float]]:
    """All edges, the smaller end first, and their lengths."""
    rows = [(node, graph.starts[node], graph.starts[node + 1]) for node in range(graph.size)]
    found = [(node, int(graph.ends[k]), float(graph.lengths[k])) for node, a, b in rows for k in range(a, b)]
    return [(a, b, length) for a, b, length in found if a < b]


def other_robot(world: RobotWorld, places: set[Any], rng: np.random.Generator) -> tuple[RobotWorld, int]:
    """The same of a robot's walls: cells that no beam has crossed or met, and that the body was nowhere near."""
    known, luck = RobotMap(world.task), np.random.default_rng(0)
    rows, columns = np.indices(world.cells.shape) * 0.1 + 0.05  # [H, W]
    near = np.zeros(world.cells.shape, np.bool_)
    exact = world.task.sensor.lidar.model_copy(update={"noise": 0.0, "dropped": 0.0})
    truth = replace(world, task=world.task._replace(sensor=world.task.sensor._replace(lidar=exact)))
    for place in places:
        known.update(truth.sense(RobotState(0, place, place, 0.0, 0.0, None, blocked=False), luck))
        near |= (columns - place[0]) ** 2 + (rows - place[1]) ** 2 < 0.6**2
    changed = (known.cells == UNKNOWN) & ~near & (rng.random(near.shape) < 0.5)
    cells = np.where(changed, FREE + BLOCKED - world.cells, world.cells).astype(np.uint8)
    cells.setflags(write=False)
    return replace(world, cells=cells), int(changed.sum())


ELSEWHERE: dict[str, Callable[..., tuple[Any, int]]] = {
    "grid": other_grid,
    "graph": other_graph,
    "robot": other_robot,
    "ring": other_ring,
}


def test_what_was_never_seen_changes_nothing(
    agent: AgentSettings, meetings: list[World], play: Callable[..., Any]
) -> None:
    """Two worlds that differ only where the agent has not looked get the same actions, bytes and effort."""
    changed = []
    for seed, world in enumerate(meetings):
        episode = list(play(world, agent, seed))
        places = {decision.observation.place for decision in episode}
        other, parts = ELSEWHERE[world.task.kind](world, places, np.random.default_rng(seed))
        changed.append(parts)
        again = list(play(other, agent, seed))
        assert [d[2:] for d in again] == [d[2:] for d in episode]
    assert np.mean(changed) > 5
