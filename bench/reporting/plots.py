"""The plots of a report: one PNG each, a panel for each variant, one colour and mark for each agent in all of them."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, cast

import numpy as np
import pandas as pd

from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting import canvas
from fogbench.bench.reporting.canvas import STYLE, Axes, Figure
from fogbench.bench.reporting.curves import Steps, success_by_seconds, success_by_steps
from fogbench.bench.reporting.distance_plot import Frames, against_distance
from fogbench.bench.reporting.panels import MARKS, Looks, legend, looks_of, magnitudes, panels_of, percent
from fogbench.bench.reporting.plain import folded
from fogbench.bench.reporting.words import reference_name
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array

FAR = 1.5
"""So many times the median ratio, the axis of ratios ends."""


ACROSS = 20
"""Characters in a line of a variant's name below an axis."""


def draw(frame: pd.DataFrame, table: pd.DataFrame, scenario: Scenario, folder: Path) -> tuple[list[str], list[str]]:
    """Write the plots into `folder`; none if no episode is recorded.

    Args:
        frame: recorded episodes, with the columns `fogbench.bench.reporting.report.READS`.
        table: their summary.
        scenario: says the order of variants and agents.
        folder: must be there.

    Returns:
        The names of the files, and a line on each that could not be drawn or written.
    """
    drawn, missing = list[str](), list[str]()
    for name, make in figures(frame, table, scenario).items() if len(frame) else ():
        try:
            canvas.draw(make, folder / name)
            drawn.append(name)
        except Mistake as mistake:
            missing.append(str(mistake))
    return drawn, missing


def figures(frame: pd.DataFrame, table: pd.DataFrame, scenario: Scenario) -> dict[str, Callable[[], Figure]]:
    """What makes each figure, by the names of their files; at least one episode is recorded."""
    variants = {variant.name: frame[frame["variant"] == variant.name] for variant in scenario.variants}
    frames = {name: episodes for name, episodes in variants.items() if len(episodes)}
    played = {label: look for label, look in looks_of(scenario).items() if (frame["agent"] == label).any()}
    return {
        "success.png": partial(success, table, played),
        "path_ratio.png": partial(path_ratio, table, played, reference_name(scenario)),
        "success_by_steps.png": partial(success_against_steps, frames, played),
        "success_by_seconds.png": partial(success_against_seconds, frames, played),
        "by_distance.png": partial(against_distance, frames, played, scenario),
    }


def success(table: pd.DataFrame, looks: Looks) -> Figure:
    """Success of each agent with its interval, by variant."""
    figure, (axes,) = _dots(table, ("success",), looks)
    percent(axes)
    axes.set_ylabel("success [%]")
    return figure


def path_ratio(table: pd.DataFrame, looks: Looks, reference: str) -> Figure:
    """Path ratio to the full-map optimum and to the reference on the map seen so far, with intervals, by variant.

    Who is far above most (a random walk) is off the axis, with an arrow in its place.
    """
    metrics = {"path_ratio": "optimum", "reference_ratio": f"{reference} on the map seen"}
    figure, panels = _dots(table, tuple(metrics), looks)
    for axes, (metric, other) in zip(panels, metrics.items(), strict=True):
        axes.axhline(1, color="#888888", linewidth=0.8, zorder=1)
        shown = table.loc[table["metric"] == metric, ["low", "value", "high"]].fillna(1)
        near = shown["value"] <= FAR * shown["value"].median()
        top = max(1.05, 1.02 * shown.loc[near, "high"].max())
        axes.set_ylim(min(0.98, 0.98 * shown["low"].min()), top)  # a narrower axis would make much of nothing
        axes.set_ylabel(f"length / {other},\nown successes")
        _point_beyond(axes)
    return figure


def success_against_steps(frames: Frames, looks: Looks) -> Figure:
    """Success against the step budget, up to the one that was played with."""
    figure, panels = panels_of(frames, looks, "step budget", "success [%]")
    for axes, episodes in zip(panels, frames.values(), strict=True):
        _staircases(axes, {agent: success_by_steps(cell) for agent, cell in _cells(episodes, looks)}, looks,
                    0, float(episodes["budget_steps"].max()))  # fmt: skip
    return figure


def success_against_seconds(frames: Frames, looks: Looks) -> Figure:
    """Success against a budget of wall-clock time; unfinished episodes are censored."""
    figure, panels = panels_of(frames, looks, "budget for all decisions of an episode [s]", "success [%]")
    for axes, episodes in zip(panels, frames.values(), strict=True):
        curves = {agent: success_by_seconds(cell) for agent, cell in _cells(episodes, looks)}
        spent = np.concatenate([[], *(curve.budget for curve in curves.values())])
        axes.set_xscale("log")
        magnitudes(axes.xaxis)
        _staircases(axes, curves, looks, *_around(spent))
    return figure


def _dots(table: pd.DataFrame, metrics: Sequence[str], looks: Looks) -> tuple[Figure, list[Axes]]:
    """Estimates with intervals: a panel for each metric, variants side by side, agents next to each other in each."""
    variants = list(dict.fromkeys(table["variant"]))
    width = float(np.clip(1.2 + 0.2 * len(variants) * (len(looks) + 1), 4.5, 14))
    figure = Figure(figsize=(width, 0.4 + 2.2 * len(metrics)), layout="constrained")
    panels = list(figure.subplots(len(metrics), 1, sharex=True, squeeze=False).flat)
    for axes, metric in zip(panels, metrics, strict=True):
        for k, (agent, look) in enumerate(looks.items()):
            rows = table[(table["metric"] == metric) & (table["agent"] == agent)]
            at = rows["variant"].map(variants.index) + 0.8 * ((k + 0.5) / len(looks) - 0.5)
            reach = np.maximum(0, [rows["value"] - rows["low"], rows["high"] - rows["value"]])  # [2, variants]
            axes.errorbar(at, rows["value"], reach, color=look.color, marker=look.marker, linestyle="", capsize=2)
        _side_by_side(axes, variants)
    legend(figure, looks, lines=False)
    return figure, panels


def _point_beyond(axes: Axes) -> None:
    """An arrow at the upper end of the axis for each mark above it."""
    top = axes.get_ylim()[1]
    for line in (line for line in axes.lines if str(line.get_marker()) in MARKS):
        look = {"arrowstyle": "->", "color": line.get_color()}
        for x, value in np.column_stack(cast(Any, line.get_data())).astype(np.float64).tolist():
            if value > top:
                axes.annotate("", (x, top), (0, -12), textcoords="offset points", arrowprops=look)


def _side_by_side(axes: Axes, variants: Sequence[str]) -> None:
    axes.set_xticks(range(len(variants)), [folded(variant, ACROSS) for variant in variants])
    axes.set_xlim(-0.5, len(variants) - 0.5)
    axes.grid(visible=False, axis="x")
    for border in range(1, len(variants)):
        axes.axvline(border - 0.5, color=STYLE["grid.color"], linewidth=STYLE["grid.linewidth"], zorder=0)


def _staircases(axes: Axes, curves: Mapping[str, Steps], looks: Looks, left: float, right: float) -> None:
    for agent, (budget, solved) in curves.items():
        height = 100 * np.concatenate([[0], solved, solved[-1:] if len(solved) else [0]])
        at = [left, *budget, right]
        axes.step(at, height, where="post", markevery=[-1], clip_on=False, **looks[agent]._asdict())
    axes.set_xlim(left, right)
    percent(axes)


def _around(seconds: Array) -> tuple[float, float]:
    """Ends of a logarithmic axis for all of `seconds` [n] that are more than nothing."""
    seconds = seconds[seconds > 0]
    return (seconds.min() / 2, seconds.max() * 2) if len(seconds) else (1e-3, 1.0)


def _cells(episodes: pd.DataFrame, looks: Looks) -> Iterator[tuple[str, pd.DataFrame]]:
    for agent in looks:
        cell = episodes[episodes["agent"] == agent]
        if len(cell):
            yield agent, cell
