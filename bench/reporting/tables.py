"""Tables of text: how a number is written, and how a table looks in Markdown and in a terminal."""

from collections.abc import Sequence
from itertools import zip_longest
from typing import Any, NamedTuple

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.cells import cell_len
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table as RichTable
from rich.text import Text

from fogbench.bench.reporting.metrics import Metric
from fogbench.bench.reporting.plain import escaped, plain
from fogbench.bench.reporting.statistics import Estimate

NOTHING = "—"
"""What stands where nothing was measured."""

SCALES = {
    "ms": (("µs", 1e-3), ("ms", 1.0), ("s", 1e3)),
    "bytes": (("B", 1.0), ("KiB", 2.0**10), ("MiB", 2.0**20), ("GiB", 2.0**30)),
}
"""The units that a time [ms] and a size [bytes] are written in, smallest first."""


WIDTH = 120
"""Columns of text that a table may take even where the terminal has fewer, or a pipe pretends to have 80."""

WIDEST = 40
"""Columns of text that a column takes for a long label; in a terminal the rest stands below."""

LEAST, MOST = 20, 10_000
"""Columns of text below which the last column of a table does not give way, and more than any table needs."""


class Lines(NamedTuple):
    """A table: a heading for each column, and rows of as many texts."""

    headings: Sequence[str]
    rows: Sequence[Sequence[str]]


def heading(metric: Metric) -> str:
    """What stands over a metric's column, with its unit unless each number says its own."""
    return metric.heading if not metric.unit or metric.unit in SCALES else f"{metric.heading} [{metric.unit}]"


def written(estimate: Estimate, metric: Metric, *, interval: bool = True) -> str:
    """An estimate as a report prints it: `96.3 [94.9, 97.3]`, `12.3 ms`, `4.1 KiB`, `∞`, or `—`."""
    value = number(estimate.value, metric)
    if not interval or metric.unit in SCALES or not np.isfinite(estimate.low):
        return value
    return f"{value} [{number(estimate.low, metric)}, {number(estimate.high, metric)}]"


def number(value: float, metric: Metric) -> str:
    """One number of a metric; what would round to nothing is written as less than the smallest number there is."""
    if not np.isfinite(value):
        return "∞" if np.isposinf(value) else NOTHING
    if metric.unit in SCALES:
        return scaled(value, metric.unit, metric.digits)
    least = 10.0**-metric.digits
    return f"<{least:.{metric.digits}f}" if 0 < value < least / 2 else f"{value:z.{metric.digits}f}"


def scaled(value: float, unit: str, digits: int = 3) -> str:
    """A time [ms] or a size [bytes] in the first unit that needs no more than three digits before the point."""
    name, size = next((scale for scale in SCALES[unit] if value / scale[1] < 999.5), SCALES[unit][-1])
    return f"{value / size:.{digits}g} {name}"


def markdown(lines: Lines) -> str:
    """The table in Markdown, its columns aligned for those who read it as text."""
    rows = [list(map(escaped, row)) for row in (lines.headings, *lines.rows)]
    widths = [min(WIDEST, max(3, *map(cell_len, column))) for column in zip(*rows, strict=True)]
    rows.insert(1, ["-" * width for width in widths])
    padded = [[text + " " * (width - cell_len(text)) for text, width in zip(row, widths, strict=True)] for row in rows]
    return "".join(f"| {' | '.join(row)} |\n" for row in padded)


def print_table(title: str, lines: Lines, console: Console) -> None:
    """Print a table, as wide as it needs to be; blanks at the ends of its lines would wrap in a narrow terminal."""
    table = terminal(title, lines)
    least = Measurement.get(console, console.options.update(width=MOST), table).minimum
    options = console.options.update(width=max(console.width, WIDTH, least))
    for line in console.render_lines(table, options, pad=False):
        text = Text.assemble(*((segment.text, segment.style or "") for segment in line))
        text.rstrip()
        console.print(text, soft_wrap=True)


def terminal(title: str, lines: Lines) -> RichTable:
    """The table for a terminal.

    A gap stands where the first column changes. If space is short, the last column gives way, and so do long labels.
    """
    rows = [list(map(plain, row)) for row in lines.rows]
    look: dict[str, Any] = {"title_justify": "left", "title_style": "bold", "box": SIMPLE_HEAD, "show_edge": False}
    table = RichTable(title=f"\n{title}", padding=0, **look)
    for k, text in enumerate(lines.headings):
        widest, last = max((cell_len(row[k]) for row in rows), default=0), k == len(lines.headings) - 1
        least, most = (LEAST, None) if last else (WIDEST, WIDEST)
        limits: dict[str, Any] = {"min_width": min(widest, least), "max_width": most}
        table.add_column(
            Text(plain(text).replace(" ", "\n")), no_wrap=not last and widest <= WIDEST, overflow="fold", **limits
        )
    for row, after in zip_longest(rows, rows[1:]):
        table.add_row(*map(Text, row), end_section=after is not None and after[0] != row[0])
    return table
