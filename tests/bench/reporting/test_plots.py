"""The plots: pictures with the right panels, drawn without touching anything global."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from PIL import Image

from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reading.variant import Entry
from fogbench.bench.reporting import plots
from fogbench.bench.reporting.canvas import Figure, ours
from fogbench.bench.reporting.panels import Look, looks_of, panels_of
from fogbench.bench.reporting.plots import draw
from fogbench.bench.reporting.report import summary

Recorded = Callable[..., pd.DataFrame]
Make = Callable[..., Scenario]

PANELS = {
    "success.png": 1, "path_ratio.png": 2, "success_by_steps.png": 2, "success_by_seconds.png": 2,
    "by_distance.png": 4,
}  # fmt: skip
"""How many panels each plot of two variants has."""


@pytest.fixture
def frame(recorded: Recorded) -> pd.DataFrame:
    """Two variants; A* solves everything and the memoryless planner nothing."""
    return recorded(
        *(
            {"variant": variant, "agent": agent, "outcome": outcome, "episode": k, "steps": k, "shortest": float(k)}
            for variant in ("short", "long")
            for agent, outcome in (("astar", "REACHED"), ("memoryless", "COLLIDED"))
            for k in range(1, 7)
        )
    )


def figures(frame: pd.DataFrame, scenario: Scenario) -> dict[str, Figure]:
    """All figures, not written."""
    with ours():
        return {name: make() for name, make in plots.figures(frame, summary(frame, scenario), scenario).items()}


def curve(axes: Any, scenario: Scenario, agent: str) -> tuple[list[float], list[float]]:
    """The points of an agent's line."""
    colour = looks_of(scenario)[agent].color
    (line,) = [line for line in axes.lines if line.get_color() == colour]
    return list(line.get_xdata()), list(line.get_ydata())


def test_every_plot_has_its_panels(frame: pd.DataFrame, make: Make) -> None:
    """One a variant, titled by it; success has one for all, path ratio one for each optimum."""
    drawn = figures(frame, make())
    assert {name: len(figure.axes) for name, figure in drawn.items()} == PANELS
    assert [axes.get_title() for axes in drawn["success_by_steps.png"].axes] == ["short", "long"]


@pytest.mark.parametrize("chosen", [slice(None), slice(0, 12), slice(0, 1), slice(6, 7)])
def test_plots_are_pictures_whatever_was_recorded(
    chosen: slice, frame: pd.DataFrame, make: Make, tmp_path: Path
) -> None:
    """Two variants, one variant, one success, and one failure: five PNGs with something on them."""
    frame, scenario = frame[chosen], make()
    assert draw(frame, summary(frame, scenario), scenario, tmp_path) == (list(PANELS), [])
    for name in PANELS:
        with Image.open(tmp_path / name) as picture:
            assert picture.format == "PNG"
            assert len(np.unique(np.asarray(picture.convert("L")))) > 10


def test_an_agent_looks_the_same_in_all_plots(frame: pd.DataFrame, make: Make) -> None:
    """The legend of every plot shows the agents that played, in the colours of the scenario."""
    scenario = make()
    looks = looks_of(scenario)
    for figure in figures(frame, scenario).values():
        (legend,) = figure.legends
        shown = {
            text.get_text(): line.get_color() for text, line in zip(legend.texts, legend.legend_handles, strict=True)
        }
        assert shown == {agent: looks[agent].color for agent in ("astar", "memoryless")}


def test_the_looks_of_twenty_agents_differ(make: Make) -> None:
    """Where colours repeat, marks and dashes do not."""
    scenario = make()
    entries = tuple(Entry(f"agent{k}", "", None, "") for k in range(20))
    scenario = replace(scenario, variants=(replace(scenario.variants[0], agents=entries),))
    assert len(set(looks_of(scenario).values())) == 20


def test_the_curve_of_steps_ends_at_the_budget(frame: pd.DataFrame, make: Make) -> None:
    """Six successes after 1 to 6 steps climb by a sixth each; the failures stay on the floor."""
    scenario = make()
    axes = figures(frame, scenario)["success_by_steps.png"].axes[0]
    steps, solved = curve(axes, scenario, "astar")
    assert steps == [0, 1, 2, 3, 4, 5, 6, 6]
    assert solved == pytest.approx([0, *(100 * k / 6 for k in range(1, 7)), 100])
    assert curve(axes, scenario, "memoryless") == ([0, 6], [0, 0])


def test_the_curve_of_time_has_a_logarithmic_axis_around_all_successes(frame: pd.DataFrame, make: Make) -> None:
    """All took 10 ms; where nobody succeeded there is an axis too."""
    axes = figures(frame, make())["success_by_seconds.png"].axes[0]
    assert axes.get_xscale() == "log"
    assert axes.get_xlim() == pytest.approx((0.005, 0.02))
    assert figures(frame[6:7], make())["success_by_seconds.png"].axes[0].get_xlim() == (1e-3, 1)


def test_memory_says_its_unit(frame: pd.DataFrame, make: Make) -> None:
    """Ticks are sizes, and nothing carried has its place on the axis."""
    axes = figures(frame, make())["by_distance.png"].axes[2]
    assert axes.yaxis.get_major_formatter()(4096) == "4 KiB"
    assert axes.get_ylim()[0] == 0
    assert axes.figure.get_supxlabel() == "goal distance [cells]"


def test_goals_ever_farther_away_share_one_axis(frame: pd.DataFrame, make: Make) -> None:
    """Variants of one map family without a distance in common: one line of each agent runs through them all."""
    scenario = make()
    frame.loc[frame["variant"] == "short", "shortest"] += 100
    success, memory = figures(frame, scenario)["by_distance.png"].axes
    assert success.get_title() == "long … short"
    assert curve(success, scenario, "astar") == ([3.5, 103.5], [100, 100])
    assert curve(memory, scenario, "memoryless")[0] == [3.5, 103.5]
    assert memory.get_xscale() == "log"


def test_drawing_leaves_the_settings_of_matplotlib_alone(frame: pd.DataFrame, make: Make, tmp_path: Path) -> None:
    """Who plots in the same process keeps his own settings."""
    before = {name: mpl.rcParams[name] for name in mpl.rcParams}
    draw(frame, summary(frame, make()), make(), tmp_path)
    assert {name: mpl.rcParams[name] for name in mpl.rcParams} == before


def test_an_axis_of_ratios_makes_nothing_of_noise(frame: pd.DataFrame, make: Make) -> None:
    """However close to 1 the ratios are, the axis reaches from 0.99 to 1.05 at least, in plain numbers."""
    frame["length"] = frame["shortest"] * 1.0001
    axes = figures(frame, make())["path_ratio.png"].axes[0]
    low, high = axes.get_ylim()
    assert low <= 0.99
    assert high >= 1.05
    assert axes.yaxis.get_major_formatter().get_useOffset() is False


def test_trainings_of_one_network_look_alike(recorded: Recorded, make: Make) -> None:
    """They share a look that no other has, and their place in the legend, which has the network's name."""
    labels = ("Net", "Net, seed 1", "Net, seed 2")
    scenario = make(agents=[*({"random_walk": {"label": label}} for label in labels), "astar"], reference="astar")
    looks = looks_of(scenario)
    assert len({looks[label] for label in labels}) == 1
    assert looks["astar"] != looks["Net"]
    frame = recorded({}, *({"agent": label} for label in labels)).assign(episode=0)
    for figure in figures(frame, scenario).values():
        (legend,) = figure.legends
        assert [text.get_text() for text in legend.texts] == ["Net", "astar"]


def test_a_legend_is_inside_its_figure() -> None:
    """However many agents there are and however long their labels."""
    for count, length in ((2, 5), (17, 12), (9, 40), (3, 200)):
        looks = {f"{k}".rjust(length, "x"): Look("#000000", "o", "-") for k in range(count)}
        with ours():
            figure, _ = panels_of(["a"], looks, "x", "y")
            figure.draw_without_rendering()
        (drawn,) = figure.legends
        assert drawn.get_window_extent().x0 >= 0
        assert drawn.get_window_extent().x1 <= figure.bbox.x1
        assert figure.axes[0].get_position().height * figure.get_figheight() > 1  # inch


def test_an_arrow_stands_for_what_is_far_above(frame: pd.DataFrame, make: Make) -> None:
    """A mark many times above the median does not flatten all others; those near it have no arrow."""
    frame["outcome"] = "REACHED"
    frame["length"] = frame["shortest"] * np.where(frame["agent"] == "memoryless", 9, 1.01)
    most = frame[(frame["agent"] == "astar") | (frame["variant"] == "short")]
    axes = figures(most, make())["path_ratio.png"].axes[0]
    assert axes.get_ylim()[1] < 2
    (arrow,) = axes.texts
    assert arrow.xy[1] == axes.get_ylim()[1]


def test_one_bin_has_its_interval(frame: pd.DataFrame, make: Make) -> None:
    """Six successes of six are shown with Wilson's interval, though a band over one distance would have no width."""
    axes = figures(frame, make())["by_distance.png"].axes[0]
    ((_, low), (_, high)) = axes.collections[0].get_segments()[0]
    assert (low, high) == pytest.approx((61, 100), abs=0.1)


LABELS = [
    "Ba$$in",
    "$\\floor{x}$",
    "_hidden",
    "a^b_c\\",
    "\u00e9\u0301\U0001f680\u4e2d",
    "x" * 100,
]


def test_no_label_is_read_as_markup(recorded: Recorded, make: Make, tmp_path: Path) -> None:
    """Neither TeX nor an underscore nor what a font lacks: all plots come out, and their legends show the labels."""
    scenario = make(agents=[{"astar": {"label": label}} for label in LABELS], reference=LABELS[0], budget={"steps": 9},
                    variants={"$v_{": {}, "_" * 100: {}})  # fmt: skip
    frame = recorded(*({"agent": label, "variant": v.name} for v in scenario.variants for label in LABELS))
    assert draw(frame, summary(frame, scenario), scenario, tmp_path) == (list(PANELS), [])
    for figure in figures(frame, scenario).values():
        shown = [text.get_text() for text in figure.legends[0].get_texts()]
        assert shown[:4] == LABELS[:4]
        assert not any(text.get_parse_math() for text in figure.legends[0].get_texts())
        assert max(figure.get_size_inches()) < 30
    with Image.open(tmp_path / "by_distance.png") as picture:
        assert max(picture.size) < 6000


def test_one_plot_that_fails_takes_no_other_with_it(
    frame: pd.DataFrame, make: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A line names it and says why."""

    def broken(*_: object) -> Figure:
        raise ZeroDivisionError("no\nfigure")

    monkeypatch.setattr(plots, "success", broken)
    (tmp_path / "by_distance.png").mkdir()
    drawn, (first, second) = draw(frame, summary(frame, make()), make(), tmp_path)
    assert drawn == list(PANELS)[1:-1]
    assert first == (
        f"{tmp_path}/success.png: got ZeroDivisionError: no; expected a plot that can be drawn and written."
    )
    assert second.startswith(f"{tmp_path}/by_distance.png: got IsADirectoryError: ")


def test_settings_of_others_change_no_plot(
    frame: pd.DataFrame, make: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever a plug-in does to Matplotlib in the same process, the bytes are the same."""
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        draw(frame, summary(frame, make()), make(), tmp_path / name)
        for key, value in {"text.usetex": True, "font.size": 30, "savefig.format": "svg", "axes.grid": False}.items():
            monkeypatch.setitem(mpl.rcParams, key, value)
    for name in PANELS:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_logarithmic_axes_have_plain_numbers(frame: pd.DataFrame, make: Make) -> None:
    """Powers of ten would need the mark-up that no label may have."""
    frame["decision_seconds"] = [(10.0 ** (k % 6 - 3),) for k in range(len(frame))]
    figure = figures(frame, make())["success_by_seconds.png"]
    with ours():
        figure.draw_without_rendering()
    ticks = [text.get_text() for text in figure.axes[0].get_xticklabels()]
    assert "0.01" in ticks
    assert not any("$" in text for text in ticks)
