"""The reference: A* on the map seen so far."""

import numpy as np

from bench.judge import GridJudge
from bench.loop import Record, roll
from planners.astar import AStar
from worlds.blobs import Blobs
from worlds.conditions import BudgetSettings
from worlds.grid import GridConditions
from worlds.types import Outcome


def test_every_move_begins_a_shortest_path_on_the_known_map() -> None:
    """By breadth-first search over what it has seen, no decision of A* in 50 dense worlds is wrong."""
    family = Blobs(size=16, obstacles=(30, 70), obstacle_size=(1, 2))
    conditions = GridConditions(budget=BudgetSettings(steps=256))
    for seed in range(50):
        rng = np.random.default_rng(seed)
        world = family.sample(rng, 0, conditions)
        judge = GridJudge(world.task)
        outcome = roll(world, AStar().start(world.task, rng), rng, Record(), judge)
        assert (outcome, judge.wrong, judge.strict_wrong) == (Outcome.REACHED, 0, 0), seed
