"""D* Lite, held against A* on the same known map."""

from collections.abc import Callable
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fogbench.planners.astar import AStar, glance, search
from fogbench.planners.dstar_lite import DStarLite
from fogbench.planners.incremental import FAR
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.types import BLOCKED, Array, Cell, Move

seeds = st.integers(0, 2**32 - 1)


def cost(known: Array, place: Cell, goal: Cell) -> int:
    """Length of A*'s path; FAR where there is none."""
    return len(search(known, place, goal)[0]) - 1 if len(search(known, place, goal)[0]) else FAR


def first_best(known: Array, place: Cell, goal: Cell) -> Move | None:
    """The first move, in move order, that starts a shortest path; None where there is none."""
    for move in Move:
        ahead = place[0] + move.delta[0], place[1] + move.delta[1]
        inside = 0 <= ahead[0] < known.shape[0] and 0 <= ahead[1] < known.shape[1]
        if inside and known[ahead] != BLOCKED and cost(known, ahead, goal) + 1 == cost(known, place, goal):
            return move
    return None


@given(seeds, st.sampled_from([0.0, 0.1, 0.3]), st.sampled_from([0.0, 0.3]), st.sampled_from(["stay", "sideways"]))
@settings(max_examples=500)
def test_cost_and_move_are_those_of_astar_at_every_step(
    strew: Callable[..., GridWorld], explore: Callable[..., Any], seed: int, noise: float, slip: float, slip_to: str
) -> None:
    """Whatever cells flip and wherever a slip leads, the repaired search knows what a fresh one finds."""
    rng = np.random.default_rng(seed)
    sensor = {"radius": int(rng.integers(1, 4)), "occlusion": bool(rng.integers(2)), "false_readings": noise}
    rules = {"collision": "blocked", "slip": slip, "slip_to": slip_to}
    world = strew(rng, steps=40, sensor=sensor, rules=rules)
    goal = world.task.goal
    for agent, observation, action, _ in explore(DStarLite(), world, rng):
        known, place = agent.known.cells, observation.place
        assert agent.rhs[place] == cost(known, place, goal)
        best = first_best(known, place, goal)
        assert action is (glance(goal, known.shape, observation)[0] if best is None else best)


def test_a_repair_costs_less_than_a_fresh_search(strew: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """Over 20 maps of up to 60 x 60 it expands fewer cells than A* that plans again after every change."""
    expanded = [0, 0]
    for seed in range(20):
        world = strew(np.random.default_rng(seed), side=60)
        for k, planner in enumerate((DStarLite(), AStar(replan="change"))):
            *_, last = explore(planner, world, np.random.default_rng(seed))
            expanded[k] += last.agent.search_nodes()
    assert expanded[0] < expanded[1]


def test_a_closed_map_leaves_the_current_view(misled: Callable[..., Any]) -> None:
    """With the goal read as blocked it gives up; once the goal is out of view, it plans on the view alone."""
    actions, _ = misled(DStarLite())
    assert actions == [None, Move.RIGHT]


def test_a_goal_underfoot_leaves_no_move(draw: Callable[..., GridWorld], explore: Callable[..., Any]) -> None:
    """Where the goal does not count before a post was visited, standing on it is the end, as for A*."""
    for planner in (DStarLite(), AStar()):
        moments = list(explore(planner, draw("P.S.G"), np.random.default_rng(0)))
        assert [moment.action for moment in moments] == [Move.RIGHT, Move.RIGHT, None]
