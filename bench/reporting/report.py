"""The report of a scenario: recorded episodes in, tables and plots out. Nothing is run again."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from rich.console import Console

from fogbench.bench.playing.agenda import is_given_up, outcomes
from fogbench.bench.playing.store import write
from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting.metrics import METRICS
from fogbench.bench.reporting.pairs import COMPARISONS, pair
from fogbench.bench.reporting.sections import headline, page, sections
from fogbench.bench.reporting.statistics import holm
from fogbench.bench.reporting.tables import print_table
from fogbench.worlds.mistake import Mistake

READS = (
    "variant", "kind", "agent", "episode", "outcome", "steps", "budget_steps", "length", "shortest",
    "reference_length", "judged", "wrong_decisions", "strict_wrong", "setup_seconds", "decision_seconds",
    "peak_memory_bytes", "search_nodes", "detail", "world_key",
)  # fmt: skip
"""The columns of `fogbench.bench.playing.episode.Episode` that a report is made of."""

COLUMNS = ("scenario", "variant", "agent", "metric", "value", "low", "high", "n", "unit")
"""The columns of `summary.csv`."""


def summary(frame: pd.DataFrame, scenario: Scenario) -> pd.DataFrame:
    """Every metric of every agent in every variant, and its comparison with the reference agent, each in one row.

    Args:
        frame: the recorded episodes of the scenario, with the columns `READS`.
        scenario: says the order of the rows and who is the reference agent.

    Returns:
        A table with the columns `COLUMNS`: a number in its unit, its 95 % interval, how many things it is made of.
    """
    table = pd.DataFrame(_answers(_rated(frame), scenario), columns=list(COLUMNS))
    together = table["metric"] == "p_holm"
    table.loc[together, "value"] = holm(table.loc[together, "value"])
    return table


def write_tables(frame: pd.DataFrame, scenario: Scenario, run: Mapping[str, Any], folder: Path) -> pd.DataFrame:
    """Write `summary.csv` and `summary.md` into `folder`.

    Args:
        frame: as for `summary`.
        scenario: what was measured; its published numbers stand beside.
        run: the content of `run.json`.
        folder: made if it is not there.

    Returns:
        The summary.

    Raises:
        StoreError: it cannot be written.
    """
    table = summary(frame, scenario)
    folder.mkdir(parents=True, exist_ok=True)
    write(folder / "summary.csv", table.to_csv(index=False, lineterminator="\n").encode())
    write(folder / "summary.md", page(frame, table, scenario, run, ()).encode())
    return table


def write_plots(
    frame: pd.DataFrame, table: pd.DataFrame, scenario: Scenario, run: Mapping[str, Any], folder: Path
) -> list[str]:
    """Write the plots, `*.png`, into `folder`, and the page again, with those that could be drawn.

    Args:
        frame: as for `summary`.
        table: its summary.
        scenario: what was measured.
        run: the content of `run.json`.
        folder: where the tables are.

    Returns:
        A line on each plot that could not be drawn; nothing else is lost with it.
    """
    missing: list[str] = []
    try:
        from fogbench.bench.reporting.plots import draw  # noqa: PLC0415  it loads Matplotlib, which tables do not need

        drawn, missing = draw(_rated(frame), table, scenario, folder)
        write(folder / "summary.md", page(frame, table, scenario, run, drawn).encode())
    except Mistake as mistake:
        missing.append(str(mistake))
    return missing


def print_tables(frame: pd.DataFrame, table: pd.DataFrame, scenario: Scenario, console: Console) -> None:
    """Print the results, means over trainings, comparisons, which episodes failed, and who was skipped.

    Nothing is cut off.

    Args:
        frame: as for `summary`.
        table: its summary.
        scenario: what was measured.
        console: where to.
    """
    print_table("Results", headline(table, scenario, short=True), console)
    for title, lines in sections(frame, table, scenario).items():
        print_table(title, lines, console)


def _answers(frame: pd.DataFrame, scenario: Scenario) -> Iterator[tuple[Any, ...]]:
    for variant in scenario.variants:
        reference = _cell(frame, variant.name, variant.reference)
        for entry in variant.agents:
            cell = _cell(frame, variant.name, entry.label)
            pairs = pair(cell, reference)
            place = (scenario.name, variant.name, entry.label)
            if len(cell):
                yield from ((*place, metric.name, *metric(cell), metric.unit) for metric in METRICS)
            if len(pairs) and entry.label != variant.reference:
                yield from ((*place, metric.name, *metric(pairs), metric.unit) for metric in COMPARISONS)


def _rated(frame: pd.DataFrame) -> pd.DataFrame:
    """Without the episodes of agents that were given up: nobody knows their rates."""
    given_up = [rows.index for _, rows in frame.groupby(["variant", "agent"]) if is_given_up(outcomes(rows))]
    return frame.drop(index=[row for rows in given_up for row in rows]) if given_up else frame  # it may be large


def _cell(frame: pd.DataFrame, variant: str, agent: str) -> pd.DataFrame:
    return frame[(frame["variant"] == variant) & (frame["agent"] == agent)]
