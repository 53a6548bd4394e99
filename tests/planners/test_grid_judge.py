"""The judge, held against all shortest paths that networkx finds."""

from collections.abc import Callable
from typing import Any

import networkx as nx
import numpy as np
import pytest

from fogbench.bench.playing.loop import Clerk, Record, roll
from fogbench.planners.astar import AStar
from fogbench.planners.grid_judge import GridJudge
from fogbench.planners.memoryless import Memoryless
from fogbench.planners.random_walk import RandomWalk
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.types import BLOCKED, Array, Cell, Move, Observation

MAPS = Blobs(size=7, obstacles=(3, 9), obstacle_size=(1, 3))
NOISE = {"false_readings": 0.2, "slip": 0.2, "slip_to": "sideways", "collision": "blocked"}

Decisions = list[tuple[Observation, Move]]


class Writer(list[tuple[Observation, Move]]):
    """Sits in the clerk's place and only writes decisions down."""

    def stands(self, state: Any) -> None:
        """Leave out where the agent stands."""

    def decided(self, observation: Observation, move: Move) -> None:
        """Write down a decision."""
        self.append((observation, move))


class Counting(GridJudge):
    """A judge that adds its verdicts up."""

    counts = (0, 0, 0)

    def hear(self, observation: Observation, move: Move) -> None:
        """Judge a decision."""
        self.see(observation)
        judged, wrong, strictly_wrong = self.judge(move)
        self.counts = self.counts[0] + judged, self.counts[1] + wrong, self.counts[2] + strictly_wrong


def decisions(world: GridWorld, settings: Any, seed: int) -> Decisions:
    """All decisions of an agent in an episode."""
    clerk: Any = Writer()
    agent = settings.start(world.task, np.random.default_rng(seed))
    roll(world, agent, np.random.default_rng(seed + 1), Record(), clerk)
    return list(clerk)


def best(known: Array, place: Cell, goal: Cell) -> set[Cell] | None:
    """The cells that a shortest path may go to next, by networkx; None where no path exists or none is needed."""
    graph = nx.grid_2d_graph(*known.shape)
    graph.remove_nodes_from(list(map(tuple, np.argwhere(known == BLOCKED).tolist())))
    if place == goal or goal not in graph or not nx.has_path(graph, place, goal):
        return None
    return {path[1] for path in nx.all_shortest_paths(graph, place, goal)}


@pytest.mark.parametrize("settings", [AStar(), Memoryless(), RandomWalk()], ids=lambda s: type(s).__name__)
@pytest.mark.parametrize("noise", [{}, NOISE], ids=["exact", "noisy"])
def test_the_judge_agrees_with_all_shortest_paths(
    conditions: Callable[..., Any], settings: Any, noise: dict[str, Any]
) -> None:
    """After every decision the counts are those of a brute force; without a path a decision is not judged."""
    undefined = 0
    for seed in range(6):
        world = MAPS.sample(np.random.default_rng(seed), 0, conditions(steps=25, distance=(5, 20), **noise))
        judge, reference = Counting(world.task), AStar().start(world.task, np.random.default_rng(0))
        known, judged, wrong, strict = KnownMap(world.task.extent), 0, 0, 0
        for observation, move in decisions(world, settings, seed):
            known.update(observation)
            expected = reference.act(observation)
            judge.hear(observation, move)
            ahead = (observation.place[0] + move.delta[0], observation.place[1] + move.delta[1])
            right = best(known.cells, observation.place, world.task.goal)
            if right is None:
                undefined += 1
            else:
                judged, wrong, strict = judged + 1, wrong + (ahead not in right), strict + (move is not expected)
            assert judge.counts == (judged, wrong, strict)
    assert undefined == 0 or noise


@pytest.mark.parametrize("noise", [{}, NOISE], ids=["exact", "noisy"])
def test_a_star_is_never_wrong_by_its_own_measure(conditions: Callable[..., Any], noise: dict[str, Any]) -> None:
    """A* never differs from A*, and on a map that reads true it is never wrong either."""
    judged = 0
    for seed in range(20):
        world = MAPS.sample(np.random.default_rng(seed), 0, conditions(steps=25, distance=(5, 20), **noise))
        judge = Counting(world.task)
        for observation, move in decisions(world, AStar(), seed):
            judge.hear(observation, move)
        assert judge.counts[2] == 0
        assert judge.counts[1] == 0 or noise
        judged += judge.counts[0]
    assert judged > 100


def test_a_walled_off_goal_is_not_judged(draw: Callable[..., GridWorld]) -> None:
    """While the wall is unseen a move away from the goal is wrong; once it is seen, no move is right or wrong."""
    world = draw("..#.\nS.#G\n..#.")
    judge, state, luck = Counting(world.task), world.reset(), np.random.default_rng(0)
    seen = []
    for move in (Move.UP, Move.DOWN, Move.RIGHT, Move.UP, Move.LEFT):
        judge.hear(world.sense(state, luck), move)
        seen.append(judge.counts)
        state = world.step(state, move, luck).state
    assert seen == [(1, 1, 1), (2, 1, 1), (3, 1, 1), (3, 1, 1), (3, 1, 1)]


def test_equal_paths_are_all_right_but_one_is_a_stars(draw: Callable[..., GridWorld]) -> None:
    """On open ground two moves lead to the goal: neither is wrong, and the one A* does not take is strictly wrong."""
    world = draw("S..\n...\n..G")
    seen = []
    for move in Move:
        judge = Counting(world.task)
        judge.hear(world.sense(world.reset(), np.random.default_rng(0)), move)
        seen.append(judge.counts)
    assert seen == [(1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 1)]


def test_at_a_goal_that_does_not_count_yet_nothing_is_judged(draw: Callable[..., GridWorld]) -> None:
    """Before a tunnel's end wall was in view, its goal is a cell that no shortest path leads away from."""
    world = draw("SG...P")
    judge = Counting(world.task)
    first = world.step(world.reset(), Move.RIGHT, np.random.default_rng(0))
    judge.hear(world.sense(first.state, np.random.default_rng(0)), Move.RIGHT)
    assert not first.reached
    assert judge.counts == (0, 0, 0)


def test_outcomes_do_not_depend_on_the_judge(draw: Callable[..., GridWorld]) -> None:
    """An episode that is judged is the episode that is not."""
    world = draw("S.#.\n..#G\n....", **NOISE)
    records = []
    for judge in (GridJudge(world.task), None):
        records.append(Record())
        agent = AStar().start(world.task, np.random.default_rng(0))
        clerk = Clerk(world, judge, records[-1])
        records[-1].outcome = roll(world, agent, np.random.default_rng(3), records[-1], clerk)
    judged, plain = records
    assert judged.judged > plain.judged == 0
    assert (judged.outcome, judged.actions, judged.length) == (plain.outcome, plain.actions, plain.length)
    assert judged.remaining == plain.remaining


def test_a_goal_that_reads_blocked_is_not_judged(draw: Callable[..., GridWorld]) -> None:
    """After a false reading of the goal no path leads there, until a later reading frees it."""
    world = draw("S.\n.G")
    judge, true = Counting(world.task), world.sense(world.reset(), np.random.default_rng(0))
    false = true.view.copy()
    false[2, 2] = BLOCKED
    judge.hear(true._replace(view=false), Move.DOWN)
    assert judge.counts == (0, 0, 0)
    judge.hear(true, Move.DOWN)
    assert judge.counts == (1, 0, 0)
