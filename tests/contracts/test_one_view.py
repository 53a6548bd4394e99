"""The first promise: what an agent has not looked at cannot change what it does."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.sight import look
from fogbench.worlds.types import BLOCKED, FREE, AgentSettings, Cell, World


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


ELSEWHERE: dict[str, Callable[..., tuple[Any, int]]] = {"grid": other_grid, "ring": other_ring}


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
