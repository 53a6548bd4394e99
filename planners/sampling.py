"""One run of a sampling planner of OMPL, in any space."""

from collections.abc import Sequence
from itertools import chain, repeat
from typing import Any

from ompl import base, geometric, util

SEEDS = 2**31
"""OMPL's seeds are the whole numbers from 1 to this."""

STRAIGHT = 1 + 1e-9
"""A path of up to this many straight distances is as short as can be, rounding apart."""

util.noOutputHandler()


def solved(
    information: Any, ends: Sequence[Any], name: str, iterations: int, seed: int
) -> tuple[Sequence[Any], int, bool]:
    """The best path that a planner has found from one state to another; a straight one ends the search.

    Args:
        information: of the space, with what is valid in it.
        ends: two of its states, both valid.
        name: of the planner, as OMPL has it.
        iterations: of its loop.
        seed: from 1 to SEEDS; the same arguments give the same path.

    Returns:
        The states of the path, from the start on, none if there is none; vertices of all trees; and whether the path
        ends at the goal, or else at the state nearest to it that was reached.
    """
    util.RNG.setSeed(seed)
    problem = base.ProblemDefinition(information)
    problem.setStartAndGoalStates(*ends)
    shortest = base.PathLengthOptimizationObjective(information)
    shortest.setCostThreshold(base.Cost(STRAIGHT * information.distance(*ends)))
    problem.setOptimizationObjective(shortest)
    planner = getattr(geometric, name)(information)
    if isinstance(planner, geometric.RRTstar):
        planner.setKNearest(False)  # neighbours in a ball: a sixth of the time of the k nearest
        planner.setNewStateRejection(True)  # branch and bound: half the time again, and shorter paths
    planner.setProblemDefinition(problem)
    planner.setup()
    planner.solve(base.PlannerTerminationCondition(chain(repeat(False, iterations), repeat(True)).__next__))
    tree = base.PlannerData(information)
    planner.getPlannerData(tree)
    path = problem.getSolutionPath()
    return path.getStates() if path else [], tree.numVertices(), problem.hasExactSolution()
