"""One A* search on fully known 512x512 maps, 4-connected, unit costs: each in its own form of the same map.

Before anything is timed, all three must find paths of the same length. pyastar2d's check of the least weight and its
copy of the map are part of its call, as the fresh search arrays are of ours.
"""

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from time import process_time

import nano_astar
import numpy as np
import pyastar2d
from turns import Round, Turns, milliseconds

from fogbench.planners.astar import search
from fogbench.worlds.conditions import BudgetSettings, Tasks
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.movingai import MovingAI
from fogbench.worlds.types import BLOCKED, FREE, MapFamily

TASKS = 10
"""Worlds of each family."""

LONG = GridConditions(tasks=Tasks(distance=(800, 10_000)), budget=BudgetSettings(steps=10_000))
BLOBS = Blobs(size=512, obstacles=(1500, 1500), obstacle_size=(1, 16))

Search = Callable[[], int]
"""Runs one search and returns the number of cells on its path."""


def searches() -> Iterator[Turns]:
    """Ours beside both peers, on blobs, and on a city where its file is at hand."""
    families: dict[str, MapFamily] = {"blobs": BLOBS}
    if "FOGBENCH_MAPS" in os.environ:
        families["Boston_2_512"] = MovingAI(map=Path(os.environ["FOGBENCH_MAPS"], "movingai", "Boston_2_512.map"))
    else:
        print("FOGBENCH_MAPS is not set: no search on a city map.")
    for name, family in families.items():
        worlds = [family.sample(np.random.default_rng(k), k, LONG) for k in range(TASKS)]
        ours, pyastar, nano = ([make(world) for world in worlds] for make in (our_search, pyastar_search, nano_search))
        check(ours, pyastar)
        check(ours, nano)
        for peer, theirs in (("pyastar2d", pyastar), ("nano-astar", nano)):
            work = f"A* 512x512, {name}, paths of 800 cells and more"
            yield Turns.take(work, peer, in_rounds(ours), in_rounds(theirs), milliseconds)


def check(ours: list[Search], theirs: list[Search]) -> None:
    """All paths are of the same length."""
    lengths = [[one() for one in side] for side in (ours, theirs)]
    if lengths[0] != lengths[1]:
        raise SystemExit(f"the paths differ in length: ours {lengths[0]}, theirs {lengths[1]}")


def in_rounds(side: list[Search]) -> Round:
    """Seconds per search."""

    def one_round() -> float:
        began = process_time()
        for one in side:
            one()
        return (process_time() - began) / len(side)

    return one_round


def our_search(world: GridWorld) -> Search:
    """On the known map."""
    known = np.where(world.blocked, np.uint8(BLOCKED), np.uint8(FREE))  # [H, W]
    return lambda: len(search(known, world.start, world.task.goal)[0])


def pyastar_search(world: GridWorld) -> Search:
    """On weights, infinite where blocked."""
    weights = np.where(world.blocked, np.float32(np.inf), np.float32(1))  # [H, W]
    return lambda: len(pyastar2d.astar_path(weights, world.start, world.task.goal, allow_diagonal=False))


def nano_search(world: GridWorld) -> Search:
    """On bytes, 1 where blocked."""
    grid = world.blocked.astype(np.uint8)  # [H, W]
    return lambda: len(nano_astar.astar(grid, world.start, world.task.goal, "manhattan", diagonal=False)[0])
