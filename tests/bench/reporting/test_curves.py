"""What one run says of smaller budgets and nearer goals, by hand."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

from fogbench.bench.reporting.curves import by_distance, distance_bins, success_by_seconds, success_by_steps

Recorded = Callable[..., pd.DataFrame]


def test_success_against_steps_is_what_smaller_budgets_would_have_given(recorded: Recorded) -> None:
    """Two of four solve with 3 steps, a third with 5, the last never."""
    cell = recorded({"steps": 3}, {"steps": 5}, {"outcome": "OUT_OF_STEPS", "steps": 6}, {"steps": 3})
    curve = success_by_steps(cell)
    assert curve.budget.tolist() == [3, 5]
    assert curve.share.tolist() == [0.5, 0.75]


def test_unfinished_episodes_are_solved_by_no_time_at_all(recorded: Recorded) -> None:
    """A collision after a millisecond is no success at a millisecond; the curve ends at the share of successes."""
    cell = recorded(
        {"decision_seconds": (0.25, 0.5)}, {"outcome": "COLLIDED", "decision_seconds": (0.001,)},
        {"outcome": "HUNG", "decision_seconds": ()}, {"decision_seconds": (0.125,)},
    )  # fmt: skip
    curve = success_by_seconds(cell)
    assert curve.budget.tolist() == [0.125, 0.75]
    assert curve.share.tolist() == [0.25, 0.5]


def test_without_a_success_a_curve_has_no_jump(recorded: Recorded) -> None:
    """Nothing was solved at any budget."""
    cell = recorded({"outcome": "CRASHED"}, {"outcome": "CRASHED"})
    assert len(success_by_steps(cell).budget) == len(success_by_seconds(cell).share) == 0


def test_bins_hold_equally_many_episodes(recorded: Recorded) -> None:
    """Eight bins of 25 for 200 distances, each episode counted once however many agents played it."""
    rows = [{"shortest": float(k), "episode": k, "agent": agent} for agent in "ab" for k in range(200)]
    table = recorded(*rows)
    edges = distance_bins(table)
    assert len(edges) == 9
    assert [each.success.n for each in by_distance(table[table["agent"] == "a"], edges)] == [25] * 8


@pytest.mark.parametrize("distances", [[4.0], [4.0] * 50, [1.0, 2.0]])
def test_few_distances_make_one_bin(distances: list[float], recorded: Recorded) -> None:
    """One episode, one distance, or too few episodes for two bins."""
    table = recorded(*({"shortest": distance} for distance in distances))
    (only,) = by_distance(table, distance_bins(table))
    assert (only.distance, only.success.n) == (np.mean(distances), len(distances))


def test_a_bin_says_success_and_memory_at_its_distance(recorded: Recorded) -> None:
    """Bins [1, 5) and [5, 9]; a lost process counts as a failure, and its memory is not known."""
    table = recorded(
        {"shortest": 1.0}, {"shortest": 3.0, "outcome": "COLLIDED", "peak_memory_bytes": 300},
        {"shortest": 5.0, "peak_memory_bytes": 7},
        {"shortest": 9.0, "outcome": "HUNG", "decision_seconds": (), "peak_memory_bytes": 0},
    )  # fmt: skip
    near, far = by_distance(table, np.array([1.0, 5.0, 9.0]))
    assert (near.distance, near.success.value, near.peak_memory) == (2, 0.5, 200)
    assert (far.distance, far.success.value, far.peak_memory) == (7, 0.5, 7)
