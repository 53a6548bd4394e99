"""The report: all its numbers in a table, all its words on a page, the same bytes each time, in little memory."""

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pandas as pd
import pytest
from rich.console import Console

from fogbench.bench.playing.episode import SCHEMA
from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting.report import COLUMNS, READS, print_tables, summary, write_plots, write_tables
from fogbench.bench.reporting.sections import asked, columns, failures

Recorded = Callable[..., pd.DataFrame]
Make = Callable[..., Scenario]

PUBLISHED = {"source": "A paper, table 1", "success": {"MACN": {"short": 96.3}, "memoryless": {"short": 12}}}

MACHINE = {
    "workers": 2,
    "cpu": "Some CPU",
    "cores": 4,
    "system": "Linux",
    "versions": {"python": "3.12", "numpy": "2.0"},
}

RUN = {"seeds": {"short": 0, "long": 0}, "sessions": [{**MACHINE, "commit": "abc"}, {**MACHINE, "commit": "def"}]}

PAGE = Path(__file__).with_name("summary.md")
"""The page of the small report below, checked by hand; it ends before the explanation of the columns."""


@pytest.fixture
def frame(recorded: Recorded) -> pd.DataFrame:
    """A* solves two short episodes and a long one; the memoryless planner walks around in one and crashes in one."""
    memoryless = {"agent": "memoryless", "peak_memory_bytes": 2048}
    crashed = {"outcome": "CRASHED", "detail": "ValueError: a | b (act, line 3)"}
    return recorded(
        {"episode": 0}, {"episode": 1}, {"episode": 0, "variant": "long"},
        {"episode": 0, "length": 6.0, **memoryless},
        {"episode": 1, "wrong_decisions": 2, **crashed, **memoryless},
    )  # fmt: skip


@pytest.fixture
def scenario(make: Make) -> Scenario:
    """The small scenario with published numbers; the random walk is skipped."""
    scenario = make(published=PUBLISHED)
    variants = []
    for variant in scenario.variants:
        *others, last = variant.agents
        variants.append(replace(variant, agents=(*others, replace(last, settings=None, skipped="no legs"))))
    return replace(scenario, variants=tuple(variants))


def test_a_report_reads_columns_of_the_store() -> None:
    """Every column it asks for is one that is recorded."""
    assert set(READS) <= set(SCHEMA.names)


def test_the_summary_has_a_row_for_every_number(frame: pd.DataFrame, scenario: Scenario) -> None:
    """All metrics of the three cells that were played, and the comparisons of the one pair of agents."""
    table = summary(frame, scenario)
    metrics, compared = len(asked(scenario)) - 7, 7
    assert tuple(table.columns) == COLUMNS
    assert len(table) == 3 * metrics + compared
    one = table[(table["agent"] == "memoryless") & (table["metric"] == "success")]
    assert one[["scenario", "variant", "value", "n", "unit"]].to_numpy().tolist() == [["small", "short", 50.0, 2, "%"]]


def test_p_values_are_adjusted_over_the_whole_scenario(recorded: Recorded, make: Make) -> None:
    """Four comparisons in two variants: the smallest p, (1/2)^6 from 6 to 0 discordant pairs, counts four times."""
    frame = recorded(
        *({"episode": k, "variant": variant} for variant in ("short", "long") for k in range(6)),
        *(
            {"episode": k, "variant": variant, "agent": agent, "outcome": outcome}
            for variant, agent, outcome in (
                ("short", "memoryless", "COLLIDED"), ("short", "random_walk", "REACHED"),
                ("long", "memoryless", "REACHED"), ("long", "random_walk", "REACHED"),
            )
            for k in range(6)
        ),
    )  # fmt: skip
    table = summary(frame, make())
    values = {name: table.loc[table["metric"] == name, "value"].tolist() for name in ("p", "p_holm")}
    assert values == {"p": pytest.approx([1 / 64, 1, 1, 1]), "p_holm": pytest.approx([4 / 64, 1, 1, 1])}


def test_the_page_says_all_of_it(frame: pd.DataFrame, scenario: Scenario, tmp_path: Path) -> None:
    """The exact Markdown of a small report, up to the explanation of the columns; at first without the plots."""
    table = write_tables(frame, scenario, RUN, tmp_path)
    without = (tmp_path / "summary.md").read_text("utf-8")
    assert write_plots(frame, table, scenario, RUN, tmp_path) == []
    text, _ = (tmp_path / "summary.md").read_text("utf-8").split("## What the columns say")
    assert text == PAGE.read_text("utf-8")
    pictures = [line for line in text.splitlines() if line.startswith("![")]
    assert len(pictures) == 5
    for picture in pictures:
        text = text.replace(picture + "\n\n", "")
    assert without.startswith(text)


def test_the_page_explains_every_metric(scenario: Scenario) -> None:
    """One row each: its column, its name in the CSV, unit, direction, episodes and meaning, none of them empty."""
    rows = columns(scenario).rows
    assert [row[1] for row in rows] == list(asked(scenario))
    assert all(map(all, rows))


def test_words_come_from_the_kind(scenario: Scenario) -> None:
    """The reference of grids is called A* wherever it is told."""
    told = asked(scenario)
    assert told["reference_ratio"].heading == "ratio to A*"
    assert told["reference_ratio"].over.words == "own successes that A* solved too"
    assert not any(
        "{" in text for metric in told.values() for text in (metric.heading, metric.about, metric.over.words)
    )


def test_writing_twice_gives_the_same_bytes(frame: pd.DataFrame, scenario: Scenario, tmp_path: Path) -> None:
    """The bootstrap is seeded and nothing depends on the day: CSV and Markdown repeat."""
    for folder in ("a", "b"):
        write_tables(frame, scenario, RUN, tmp_path / folder)
    for name in ("summary.csv", "summary.md"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_the_csv_holds_the_summary(frame: pd.DataFrame, scenario: Scenario, tmp_path: Path) -> None:
    """Reading it gives back every number exactly."""
    table = write_tables(frame, scenario, RUN, tmp_path)
    pd.testing.assert_frame_equal(
        pd.read_csv(tmp_path / "summary.csv", keep_default_na=False, na_values={"value": "", "low": "", "high": ""}),
        table, check_dtype=False, rtol=0, atol=0,
    )  # fmt: skip


def test_nothing_recorded_yet_is_a_report_too(scenario: Scenario, tmp_path: Path) -> None:
    """Every agent has its row of dashes, the CSV its header, and there is no plot."""
    frame = SCHEMA.empty_table().select(list(READS)).to_pandas()
    run = {"seeds": {"short": 0}, "sessions": []}
    table = write_tables(frame, scenario, run, tmp_path)
    assert write_plots(frame, table, scenario, run, tmp_path) == []
    assert (tmp_path / "summary.csv").read_text() == ",".join(COLUMNS) + "\n"
    assert "| short   | astar       | —   |" in (tmp_path / "summary.md").read_text("utf-8")
    assert list(tmp_path.glob("*.png")) == []


@pytest.mark.parametrize("width", [40, 120])
def test_the_terminal_shows_results_comparisons_and_who_did_not_play(
    width: int, frame: pd.DataFrame, scenario: Scenario
) -> None:
    """Each line fits 120 columns, and each row of the page has its line; a narrower terminal cuts nothing off."""
    console = Console(width=width, file=StringIO())
    print_tables(frame, summary(frame, scenario), scenario, console)
    lines = [" ".join(line.split()) for line in console.file.getvalue().splitlines()]
    assert "short memoryless 2 50.0 [9.5, 90.5] 12 1.500 1.500 0.250 2.5 ms 4 ms 2 KiB 0.500" in lines
    assert "short memoryless astar -50.0 [-100.0, 56.3] 0 1 0.500 0.500 1.500 1" in lines
    assert "long random_walk no legs" in lines
    assert "short memoryless CRASHED 1 1 ValueError: a | b (act, line 3)" in lines
    assert max(map(len, console.file.getvalue().splitlines())) <= 120


def test_the_terminal_names_every_failing_episode(recorded: Recorded, scenario: Scenario) -> None:
    """So that one can be replayed, however it failed."""
    frame, console = recorded({"episode": 0}, {"episode": 1, "outcome": "TIMEOUT"}), Console(file=StringIO())
    print_tables(frame, summary(frame, scenario), scenario, console)
    lines = [" ".join(line.split()) for line in console.file.getvalue().splitlines()]
    assert "short astar TIMEOUT 1 1" in lines


def test_long_details_are_cut_to_a_line(recorded: Recorded) -> None:
    """A traceback of a thousand letters becomes one line of 200."""
    frame = recorded({"outcome": "CRASHED", "detail": "a\n  b " + "c" * 1000})
    assert failures(frame).rows[0][-1] == "a b " + "c" * 195 + "…"


def test_failures_name_episodes_to_replay(recorded: Recorded) -> None:
    """The first five of those that ended alike, by number; without a word of any agent there is no column for it."""
    lost = {"outcome": "OUT_OF_STEPS"}
    frame = recorded(*({"episode": k, **lost} for k in (40, 3, 17, 5, 4, 6)), {"episode": 9, "variant": "long", **lost})
    assert failures(frame).headings == ["variant", "agent", "outcome", "count", "episodes"]
    assert failures(frame).rows == [
        ["short", "astar", "OUT_OF_STEPS", "6", "3, 4, 5, 6, 17, …"],
        ["long", "astar", "OUT_OF_STEPS", "1", "9"],
    ]
    assert failures(frame[:0]).rows == []


LARGE = """
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa

from fogbench.bench.playing.episode import SCHEMA
from fogbench.bench.reporting.report import READS, write_plots, write_tables
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.reading.variant import Entry

n, cells = 10_000, 10
rng = np.random.default_rng(0)
agents = [f"agent{k}" for k in range(cells)]
entries = tuple(Entry(agent, "", None, "") for agent in agents)
scenario = Scenario(Path(), "", "large", "", (Variant("all", "grid", None, None, entries, agents[0], n, 0),), {}, "")
shortest = np.tile(rng.integers(1, 60, n), cells).astype(float)
numbers = {name: rng.integers(1, 60, n * cells) for name in ("steps", "peak_memory_bytes", "search_nodes", "judged")}
ends, kind = np.arange(0, 150 * n * cells + 1, 150), SCHEMA.field("decision_seconds").type
seconds = pa.ListArray.from_arrays(ends, rng.random(150 * n * cells, np.float32))
frame = pd.DataFrame({
    "variant": "all", "kind": "grid", "agent": np.repeat(agents, n), "episode": np.tile(np.arange(n), cells),
    "outcome": rng.choice(["REACHED", "COLLIDED"], n * cells), "budget_steps": 60, "length": shortest + 2,
    "shortest": shortest, "reference_length": shortest, "wrong_decisions": 0, "strict_wrong": 0, "setup_seconds": 0.1,
    "decision_seconds": pd.Series(seconds, dtype=pd.ArrowDtype(kind)), "detail": "", "world_key": "w", **numbers,
})[list(READS)]
del seconds
run, folder = {"seeds": {}, "sessions": []}, Path(__import__("sys").argv[1])
write_plots(frame, write_tables(frame, scenario, run, folder), scenario, run, folder)
print(int(re.search("VmHWM:\\s+([0-9]+)", Path("/proc/self/status").read_text())[1]) // 1024)
"""


def test_a_hundred_thousand_episodes_fit_in_500_mib(tmp_path: Path) -> None:
    """With 150 decisions each, held as the store gives them: peak resident memory of a process of its own."""
    done = subprocess.run([sys.executable, "-c", LARGE, str(tmp_path)], capture_output=True, text=True, check=True)
    assert int(done.stdout) < 500
    assert (tmp_path / "success.png").exists()
