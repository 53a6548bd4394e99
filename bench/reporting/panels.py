"""How plots look: one colour, mark and dash for each agent, a panel for each variant, one legend for them all.

Figures are made without pyplot, so nothing global is touched and no window is ever opened.
"""

from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.typing import LineStyleType

from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting.trainings import network_of

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C6D31")
"""Told apart by the colour-blind too (Okabe & Ito 2008), the palest left out."""

MARKS = "os^Dvph<>d"

DASHES: tuple[LineStyleType, ...] = ("-", "--", ":", "-.")

STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": "#E5E5E5",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "lines.linewidth": 1.5,
    "lines.markersize": 5,
}


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
        axes.set_title(name)
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
    handles = [
        Line2D([], [], color=look.color, marker=look.marker, linestyle=look.linestyle if lines else "", label=network)
        for network, look in {network_of(agent): look for agent, look in looks.items()}.items()
    ]
    for columns in range(len(handles), 0, -1):
        length = 3 if lines else 1
        drawn = figure.legend(handles=handles, loc="outside upper center", ncols=columns, handlelength=length)
        if columns == 1 or drawn.get_window_extent().width <= figure.bbox.width:
            break
        drawn.remove()
    figure.set_figheight(figure.get_figheight() + drawn.get_window_extent().height / figure.dpi)


def percent(axes: Axes) -> None:
    """An axis that shows all of 0 to 100 %."""
    axes.set_ylim(-3, 103)
    axes.set_yticks(range(0, 101, 20))
