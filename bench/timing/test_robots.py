"""Robots: the scan, the known map, whole decisions at 10 Hz in MuJoCo, and unicycles side by side.

A decision is all of it: physics, scan, known map, A* and the pilot.
"""

from functools import partial
from itertools import count, cycle
from typing import Any

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from fogbench.planners.astar import AStar
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.robot.batch import RobotBatch
from fogbench.worlds.robot.conditions import RobotConditions
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.robot.simulation import Simulation
from fogbench.worlds.robot.world import RobotState

HALLS = {
    "100 boxes": Blobs(size=200, obstacles=(60, 60), obstacle_size=(5, 20)),
    "700 boxes": Blobs(size=400, obstacles=(640, 640), obstacle_size=(3, 14)),
}

DECISIONS = 50
"""In a round."""


def worlds_of(hall: str, physics: str = "mujoco", decision: float = 0.1, beams: int = 270) -> Any:
    """Worlds without end."""
    conditions = RobotConditions.model_validate(
        {
            "body": {"decision": decision},
            "rules": {"physics": physics},
            "sensor": {"beams": beams},
            "tasks": {"distance": (8, 60)},
            "budget": {"steps": 2000},
        }
    )
    return (HALLS[hall].sample(np.random.default_rng(seed), seed, conditions) for seed in count())


@pytest.mark.parametrize("beams", [60, 270])
def test_scan(benchmark: BenchmarkFixture, beams: int) -> None:
    """One look on a map of 400x400 cells."""
    benchmark.group = "scan 400x400"
    world = next(worlds_of("700 boxes", beams=beams))
    states = cycle(places(world))
    rng = np.random.default_rng(0)
    benchmark(lambda: world.sense(next(states), rng))


def test_known_map(benchmark: BenchmarkFixture) -> None:
    """One scan of 270 beams into the known map, from ever other places, with all gaps."""
    benchmark.group = "known map 400x400"
    world, rng = next(worlds_of("700 boxes")), np.random.default_rng(0)
    looks = cycle([world.sense(state, rng) for state in places(world)])
    known = RobotMap(world.task)
    benchmark(lambda: known.update(next(looks)))


def places(world: Any) -> list[RobotState]:
    """Three hundred states at random places beside no wall."""
    rng, found = np.random.default_rng(1), list[RobotState]()
    while len(found) < 300:
        x, y, heading = rng.uniform((0, 0, -3), (*world.task.extent, 3)).tolist()
        if world.cells[int(y / 0.1), int(x / 0.1)] == 1:
            found.append(RobotState(0, (x, y, heading), (x, y, heading), 0.0, 0.0, None, blocked=False))
    return found


@pytest.mark.parametrize("hall", HALLS)
def test_decisions(benchmark: BenchmarkFixture, hall: str) -> None:
    """Some decisions at 10 Hz in MuJoCo, on from where the last round stopped; models are built outside of it."""
    benchmark.group = f"{DECISIONS} decisions at 10 Hz, {hall}"
    worlds, rng = worlds_of(hall), np.random.default_rng(0)
    live: dict[str, Any] = {}

    def ahead() -> tuple[tuple[Any, ...], dict[str, Any]]:
        if not live or live["over"] > 1500:
            live.update(world=next(worlds), over=0)
            live.update(agent=AStar().start(live["world"].task, rng), state=live["world"].reset())
        return (), {}

    def decide() -> None:
        for _ in range(DECISIONS):
            world, state = live["world"], live["state"]
            step = world.step(state, live["agent"].act(world.sense(state, rng)), rng)
            live["state"], live["over"] = step.state, live["over"] + (9999 if step.reached or step.collided else 1)
            if live["over"] > 1500:
                return

    benchmark.pedantic(decide, setup=ahead, rounds=60, warmup_rounds=3)  # type: ignore[no-untyped-call]
    print(f"\n{hall}: {len(boxes(live['world']))} boxes")


def boxes(world: Any) -> Any:
    """The geoms of its walls."""
    sim = Simulation(world.cells, world.task.sensor.cell, world.task.sensor.body)
    return [k for k in range(sim.model.ngeom) if sim.model.geom_bodyid[k] == 0][1:]


@pytest.mark.parametrize("beams", [60, 270])
def test_side_by_side(benchmark: BenchmarkFixture, beams: int) -> None:
    """A decision of each of 64 unicycles with 0.5 s each: scan, and drive to random waypoints."""
    benchmark.group = "64 unicycles"
    worlds = worlds_of("100 boxes", "unicycle", 0.5, beams)
    slots, batch, rng = np.arange(64), RobotBatch(64), np.random.default_rng(0)
    batch.reset(slots, [next(worlds) for _ in slots], [partial(np.random.default_rng, k) for k in range(64)])

    def turn() -> None:
        told = batch.sense(slots)
        batch.step(slots, told.places + rng.uniform(-1, 1, (64, 3)))

    benchmark(turn)
