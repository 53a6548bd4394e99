"""How plots look: one colour, mark and dash for each agent, a panel for each variant, one legend for them all."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting.canvas import Artist, Axes, Axis, Figure, Line2D, LineStyleType, LogFormatter
from fogbench.bench.reporting.plain import folded
from fogbench.bench.reporting.trainings import network_of

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C6D31")
"""Told apart by the colour-blind too (Okabe & Ito 2008), the palest left out."""

MARKS = "os^Dvph<>d"

DASHES: tuple[LineStyleType, ...] = ("-", "--", ":", "-.")

NARROW, BROAD = 28, 40
"""Characters of a name in a line of a panel, and of a legend."""


class Look(NamedTuple):
    """How an agent is drawn."""

    color: str
    marker: str
    linestyle: LineStyleType


Looks = Mapping[str, Look]


def looks_of(scenario: Scenario) -> dict[str, Look]:
    """The look of each agent of a scenario, whether it ran or not; trainings of one network look alike."""
    labels = dict.fromkeys(entry.label for variant in scenario.variants for entry in variant.agents)
    networks = {network: look_of(number) for number, network in enumerate(dict.fromkeys(map(network_of, labels)))}
    return {label: networks[network_of(label)] for label in labels}


def look_of(number: int) -> Look:
    """The look of the first (0), the second, ... of many."""
    colour, mark = COLOURS[number % len(COLOURS)], MARKS[number % len(MARKS)]
    return Look(colour, mark, DASHES[(number + number // len(COLOURS)) % len(DASHES)])


def panels_of(names: Collection[str], looks: Looks, x: str, y: str) -> tuple[Figure, list[Axes]]:
    """A panel for each variant."""
    rows, columns = arranged(len(names))
    figure = Figure(figsize=(1.9 + 2.4 * columns, 0.6 + 2.2 * rows), layout="constrained")
    panels = list(figure.subplots(rows, columns, sharey=True, squeeze=False).flat)
    for axes in panels[len(names) :]:
        axes.remove()
    for axes, name in zip(panels, names, strict=False):
        axes.set_title(folded(name, NARROW))
    figure.supxlabel(x, fontsize="medium")
    figure.supylabel(y, fontsize="medium")
    legend(figure, looks, lines=True)
    return figure, panels[: len(names)]


def arranged(panels: int) -> tuple[int, int]:
    """Rows and columns of so many panels, at most three in a row."""
    columns = min(3, panels)
    return -(-panels // columns), columns


def legend(figure: Figure, looks: Looks, *, lines: bool) -> None:
    """One legend over the figure, in as many columns as fit; without `lines` it shows the marks alone."""
    looks = {network_of(agent): look for agent, look in looks.items()}
    handles = [
        Line2D([], [], color=look.color, marker=look.marker, linestyle=look.linestyle if lines else "")
        for look in looks.values()
    ]
    named(figure, handles, list(looks), handlelength=3 if lines else 1)


def named(
    figure: Figure, handles: Sequence[Artist], names: Sequence[str], place: str = "upper", handlelength: float = 2
) -> None:
    """A legend outside of all panels, by which the figure grows; no name is left out, whatever it begins with."""
    look: dict[str, Any] = {"loc": f"outside {place} center", "handlelength": handlelength}
    for columns in range(len(handles), 0, -1):
        drawn = figure.legend(handles, ["x"] * len(names), ncols=columns, **look)
        for text, name in zip(drawn.get_texts(), names, strict=True):
            text.set_text(folded(name, BROAD))  # Matplotlib leaves out a label that begins with `_`
        if columns == 1 or drawn.get_window_extent().width <= figure.bbox.width:
            break
        drawn.remove()
    figure.set_figheight(figure.get_figheight() + drawn.get_window_extent().height / figure.dpi)


class Plainly(LogFormatter):
    """Numbers such as 0.01 where Matplotlib labels a logarithmic axis: its own powers of ten are mark-up."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        """The number at a tick; empty where a label would be too near to others."""
        return f"{x:g}" if super().__call__(x, pos) else ""


def magnitudes(axis: Axis) -> None:
    """Label an axis that is logarithmic already."""
    axis.set_major_formatter(Plainly(labelOnlyBase=True))
    axis.set_minor_formatter(Plainly())


def percent(axes: Axes) -> None:
    """An axis that shows all of 0 to 100 %."""
    axes.set_ylim(-3, 103)
    axes.set_yticks(range(0, 101, 20))
