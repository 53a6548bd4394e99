"""Every metric on a few episodes, by hand."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest

from fogbench.bench.reporting.metrics import METRICS, decision_milliseconds
from fogbench.bench.reporting.statistics import Estimate
from fogbench.worlds.types import Outcome

Recorded = Callable[..., pd.DataFrame]

FOUR = (
    {"steps": 4, "length": 4.0, "shortest": 4.0, "reference_length": 5.0},
    {"steps": 6, "length": 6.0, "shortest": 4.0, "reference_length": None, "judged": 5, "wrong_decisions": 2,
     "strict_wrong": 3, "setup_seconds": 0.004, "decision_seconds": (0.010, 0.020), "peak_memory_bytes": 300,
     "search_nodes": 40},
    {"outcome": "OUT_OF_STEPS", "steps": 6, "length": 6.0, "shortest": 8.0, "judged": 1, "wrong_decisions": 1,
     "strict_wrong": 1, "setup_seconds": 0.002, "decision_seconds": (0.030,), "peak_memory_bytes": 200,
     "search_nodes": 10},
    {"outcome": "HUNG", "steps": 0, "length": 0.0, "shortest": 5.0, "judged": 0, "setup_seconds": 0.0,
     "decision_seconds": (), "peak_memory_bytes": 0, "search_nodes": 0},
)  # fmt: skip
"""A success along the optimum, one with a detour that A* did not have, one out of steps, one whose process was lost."""

BY_HAND = {
    "success": (50, 4),
    "spl": ((1 + 4 / 6) / 4, 4),
    "path_ratio": ((1 + 6 / 4) / 2, 2),
    "reference_ratio": (4 / 5, 1),
    "test_error": ((0 + 2 + 1) / (4 + 5 + 1), 3),
    "strict_error": ((0 + 3 + 1) / (4 + 5 + 1), 3),
    "decision_p50": (4, 7),  # of 1, 2, 3, 4, 10, 20, 30
    "decision_p95": (20 + 0.7 * 10, 7),  # at 0.95 * 6 = 5.7, counted from 0
    "decision_max": (30, 7),
    "setup": (2, 3),  # of 1, 4, 2
    "memory_mean": (200, 3),
    "memory_max": (300, 3),
    "steps": (5, 2),
    "search_nodes": (20, 3),
    "outcome_reached": (2, 4),
    "outcome_out_of_steps": (1, 4),
    "outcome_hung": (1, 4),
    **{f"outcome_{name}": (0, 4) for name in ("collided", "gave_up", "out_of_memory", "crashed")},
}
"""Value and n of every metric on those."""


@pytest.mark.parametrize("metric", METRICS, ids=lambda metric: metric.name)
def test_a_metric_is_what_one_gets_by_hand(metric: Any, recorded: Recorded) -> None:
    """Value and n on four episodes; times in ms, shares in %."""
    estimate = metric(recorded(*FOUR))
    assert (estimate.value, estimate.n) == pytest.approx(BY_HAND[metric.name])


@pytest.mark.parametrize("metric", METRICS, ids=lambda metric: metric.name)
def test_an_interval_contains_its_estimate(metric: Any, recorded: Recorded) -> None:
    """Where a metric has an interval, its value lies in it."""
    value, low, high, _ = metric(recorded(*FOUR))
    assert np.isnan(low) == np.isnan(high)
    assert np.isnan(low) or low - 1e-12 <= value <= high + 1e-12


def test_rates_and_means_have_intervals(recorded: Recorded) -> None:
    """Percentiles, maxima and counts have none; every other metric of at least two episodes has one."""
    cell = recorded(*FOUR, *FOUR)
    without = {metric.name for metric in METRICS if np.isnan(metric(cell).low)}
    counts = {f"outcome_{outcome.name.lower()}" for outcome in Outcome}
    assert without == {"decision_p50", "decision_p95", "decision_max", "setup", "memory_max"} | counts


def test_an_agent_without_a_success_has_no_ratios(recorded: Recorded) -> None:
    """What is over own successes is not defined; the rest is, success being 0 and SPL 0."""
    cell = recorded(*FOUR[2:])
    undefined = {metric.name for metric in METRICS if np.isnan(metric(cell).value)}
    assert undefined == {"path_ratio", "reference_ratio", "steps"}
    values = {metric.name: metric(cell).value for metric in METRICS}
    assert (values["success"], values["spl"]) == (0, 0)


def test_an_agent_without_a_decision_has_no_times(recorded: Recorded) -> None:
    """Where every process was lost there is no time, memory or error: the zeros of the record are no measurements."""
    cell = recorded(FOUR[3], FOUR[3])
    defined = {metric.name for metric in METRICS if metric(cell) != Estimate() and not np.isnan(metric(cell).value)}
    assert defined == {"success", "spl"} | {f"outcome_{outcome.name.lower()}" for outcome in Outcome}


def test_a_path_shorter_than_the_optimum_counts_as_the_optimum_in_spl(recorded: Recorded) -> None:
    """SPL takes the larger of length and optimum, so it never exceeds 1."""
    spl = next(metric for metric in METRICS if metric.name == "spl")
    assert spl(recorded({"length": 3.0}, {"length": 3.0})).value == 1


@pytest.mark.parametrize("form", ["tuples", "arrays", "missing"])
def test_decisions_are_read_however_pandas_holds_them(form: str, recorded: Recorded) -> None:
    """Tuples, the arrays that a Parquet file gives, and a missing list."""
    cell = recorded({}, {"decision_seconds": (0.005,)})
    if form == "arrays":
        cell["decision_seconds"] = cell["decision_seconds"].map(np.array)
    if form == "missing":
        cell.loc[len(cell)] = {**cell.loc[0].to_dict(), "decision_seconds": None}
    assert decision_milliseconds(cell).tolist() == pytest.approx([1, 2, 3, 4, 5])


def test_the_names_of_metrics_are_unique() -> None:
    """A name in `summary.csv` says which metric it is."""
    assert len({metric.name for metric in METRICS}) == len(METRICS)
