"""How numbers and tables are written."""

from io import StringIO

import numpy as np
import pytest
from rich.cells import cell_len
from rich.console import Console
from rich.text import Text

from fogbench.bench.reporting.metrics import ALL, METRICS, Metric
from fogbench.bench.reporting.statistics import Estimate
from fogbench.bench.reporting.tables import Lines, heading, markdown, print_table, scaled, terminal, written

NAMED = {metric.name: metric for metric in METRICS}


@pytest.mark.parametrize(
    ("name", "estimate", "text"),
    [
        ("success", Estimate(96.3, 94.94, 97.32, 1000), "96.3 [94.9, 97.3]"),
        ("success", Estimate(0.0, 0.0, 1.9, 200), "0.0 [0.0, 1.9]"),
        ("success", Estimate(-0.3, -0.6, -0.04, 1000), "-0.3 [-0.6, 0.0]"),
        ("path_ratio", Estimate(1.05, n=1), "1.050"),
        ("path_ratio", Estimate(), "—"),
        ("path_ratio", Estimate(np.inf, n=1), "∞"),
        ("test_error", Estimate(0.0004, 0.0, 0.001, 9), "<0.001 [0.000, 0.001]"),
        ("decision_p50", Estimate(12.34, n=3), "12.3 ms"),
        ("memory_mean", Estimate(4200.0, 4000.0, 4400.0, 3), "4.1 KiB"),
        ("search_nodes", Estimate(1234.5, n=1), "1234"),
    ],
)
def test_a_number_says_what_is_known_and_no_more(name: str, estimate: Estimate, text: str) -> None:
    """Digits and units are those of the metric; an interval stands where there is one."""
    assert written(estimate, NAMED[name]) == text


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.0312, "ms", "31.2 µs"), (999.4, "ms", "999 ms"), (999.6, "ms", "1 s"), (90_000, "ms", "90 s"),
        (0, "bytes", "0 B"), (512, "bytes", "512 B"), (1000, "bytes", "0.977 KiB"), (65536, "bytes", "64 KiB"),
        (5 * 2**30, "bytes", "5 GiB"),
    ],
)  # fmt: skip
def test_times_and_sizes_stand_in_a_unit_that_suits_them(value: float, unit: str, text: str) -> None:
    """Never more than three digits before the point, as long as there is a larger unit."""
    assert scaled(value, unit) == text


def test_a_heading_has_a_unit_unless_its_numbers_have() -> None:
    """`12.3 ms` says its own."""
    headings = [heading(NAMED[name]) for name in ("success", "spl", "decision_p50")]
    assert headings == ["success [%]", "SPL", "decision p50"]


def test_markdown_is_aligned_and_escapes_bars() -> None:
    """A text with a bar stays one cell."""
    text = markdown(Lines(["a", "text"], [["1", "x|y"], ["22", ""]]))
    assert text == "| a   | text |\n| --- | ---- |\n| 1   | x\\|y |\n| 22  |      |\n"


def test_brackets_in_a_terminal_are_text() -> None:
    """`[1.0, 2.0]` and `[bold]` are printed as they are, not read as markup."""
    console = Console(width=40, file=StringIO())
    console.print(terminal("T", Lines(["a", "b"], [["[bold]x", "1.5 [1.0, 2.0]"]])))
    assert "[bold]x 1.5 [1.0, 2.0]" in console.file.getvalue()


def test_a_table_without_rows_has_its_headings() -> None:
    """Nothing to tell is no error."""
    console = Console(width=60, file=StringIO())
    console.print(terminal("T", Lines(["a", "b"], [])))
    assert "a" in console.file.getvalue()


def test_a_narrow_terminal_gets_no_blank_lines() -> None:
    """A table wider than the terminal is printed whole, and no line ends with blanks that would wrap; colours stay."""
    console = Console(width=20, file=StringIO(), force_terminal=True, color_system="standard")
    print_table("T", Lines(["a", "[/red] b", "c"], [["x", "y", "z" * 60], ["x", "2", "3"]]), console)
    title, *lines = Text.from_ansi(console.file.getvalue().strip("\n")).plain.splitlines()
    assert title == "T"
    assert lines[-2:] == ["x y      " + "z" * 60, "x 2      3"]
    assert [line for line in (title, *lines) if line != line.rstrip()] == []


def test_a_metric_may_be_made_anywhere() -> None:
    """A metric is a name, how it is written, and a function of the episodes it is over."""
    metric = Metric("n", "n", "", "", 0, ALL, "Episodes.", lambda cell: Estimate(float(len(cell))))
    assert written(Estimate(3.0), metric) == "3"


def test_only_the_last_column_is_broken() -> None:
    """A table whose columns need more than there is takes more; no name is cut, and no number lost."""
    console = Console(width=80, file=StringIO())
    row = ["64x64 dense", "MACN (feed-forward)", *(f"{k}" * 30 for k in range(6)), "the last word of it"]
    print_table("T", Lines([f"{k}" for k in range(9)], [row]), console)
    text = console.file.getvalue()  # type: ignore[attr-defined]
    assert all(cell in text for cell in row)
    print_table("T", Lines(["a", "b"], [["x", "long " * 100]]), console)
    text = console.file.getvalue()  # type: ignore[attr-defined]
    assert text.count("long") == 100


def test_a_long_label_is_folded() -> None:
    """It takes 40 columns, and all of it is there; wide letters count twice."""
    console = Console(width=120, file=StringIO())
    print_table("T", Lines(["agent", "n", "detail"], [["x" * 200, "3", "y"], ["\u4e2d" * 10, "4", "z"]]), console)
    text = console.file.getvalue()  # type: ignore[attr-defined]
    assert text.count("x") == 200
    assert max(map(cell_len, text.splitlines())) <= 120
    first, second = (line for line in text.splitlines() if " 3 " in line or " 4 " in line)
    assert cell_len(first[: first.index("3")]) == cell_len(second[: second.index("4")])
    rows = markdown(Lines(["agent", "n"], [["x" * 200, "3"], ["\u4e2d" * 10, "4"]])).splitlines()
    assert [cell_len(row) for row in rows if "x" not in row] == [40 + 3 + 7] * 3


def test_controls_do_not_reach_a_terminal() -> None:
    """Neither in a label nor in a heading."""
    console = Console(width=80, file=StringIO())
    print_table("T", Lines(["a\x1b", "b"], [["\x1b[31m:smile:", "c\nd"]]), console)
    text = console.file.getvalue()  # type: ignore[attr-defined]
    assert "\x1b" not in text
    assert "\\x1b[31m:smile: c d" in text
