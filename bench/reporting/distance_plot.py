"""The plot against goal distance: success above, bytes carried below, on one axis."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np
import pandas as pd

from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting.canvas import Axes, Figure, FuncFormatter
from fogbench.bench.reporting.curves import Bin, by_distance, distance_bins
from fogbench.bench.reporting.panels import NARROW, Look, Looks, arranged, legend, magnitudes, percent
from fogbench.bench.reporting.plain import folded
from fogbench.bench.reporting.tables import scaled
from fogbench.worlds import unit_of

Frames = Mapping[str, pd.DataFrame]
"""The episodes of each variant."""

LEAST_MEMORY = 256
"""The axis of memory is logarithmic above, so that agents that carry nothing have a place too [bytes]."""

WIDE = 20
"""An axis of distances whose ends differ by this factor is logarithmic."""


def against_distance(frames: Frames, looks: Looks, scenario: Scenario) -> Figure:
    """Success with Wilson's interval as a band, and below it the most bytes carried from one decision to the next.

    Variants of one map family share their panels if their goals are ever farther away: no distance is in two of them.
    """
    joined = _joined(frames, scenario)
    rows, columns = arranged(len(joined))
    figure = Figure(figsize=(1.9 + 2.4 * columns, 0.4 + 4.4 * rows), layout="constrained")
    grid = figure.subplots(2 * rows, columns, sharey="row", squeeze=False)  # [2 rows, columns] success over memory
    panels = list(zip(grid[::2].flat, grid[1::2].flat, strict=True))
    for success, memory in panels[len(joined) :]:
        success.remove()
        memory.remove()
    for (success, memory), names in zip(panels, joined, strict=False):
        success.set_title(folded(names[0] if len(names) == 1 else f"{names[0]} … {names[-1]}", NARROW))
        for look, bins in _lines([frames[name] for name in names], looks):
            _draw(success, memory, look, bins)
        _scale(success, memory)
    for success, memory in panels[::columns]:
        percent(success)
        _sizes(memory)
        success.set_ylabel("success [%]")
        memory.set_ylabel("peak memory")
    figure.supxlabel(_unit(frames), fontsize="medium")
    legend(figure, looks, lines=True)
    return figure


def _joined(frames: Frames, scenario: Scenario) -> list[list[str]]:
    """The variants of each panel, the nearest goals first."""
    families: dict[type, list[str]] = {}
    for variant in scenario.variants:
        if variant.name in frames:
            families.setdefault(type(variant.family), []).append(variant.name)
    joined: list[list[str]] = []
    for names in families.values():
        names.sort(key=lambda name: frames[name]["shortest"].min())
        apart = all(frames[a]["shortest"].max() < frames[b]["shortest"].min() for a, b in pairwise(names))
        joined += [names] if apart else [[name] for name in frames if name in names]
    return joined


def _lines(variants: Sequence[pd.DataFrame], looks: Looks) -> Iterator[tuple[Look, list[Bin]]]:
    """The bins of each agent that played; all agents of a variant have the same edges."""
    edges = [distance_bins(episodes) for episodes in variants]
    for agent, look in looks.items():
        cells = [episodes[episodes["agent"] == agent] for episodes in variants]
        if bins := [each for cell, ends in zip(cells, edges, strict=True) for each in by_distance(cell, ends)]:
            yield look, bins


def _draw(success: Axes, memory: Axes, look: Look, bins: list[Bin]) -> None:
    shares = np.array([each.success.times(100)[:3] for each in bins])  # [bins, 3] value, low, high
    distance = [each.distance for each in bins]
    success.plot(distance, shares[:, 0], **look._asdict())
    if len(bins) == 1:  # a band would have no width
        success.vlines(distance, shares[:, 1], shares[:, 2], color=look.color, linewidth=0.8)
    success.fill_between(distance, shares[:, 1], shares[:, 2], color=look.color, alpha=0.12, linewidth=0)
    memory.plot(distance, [each.peak_memory for each in bins], clip_on=False, **look._asdict())


def _scale(success: Axes, memory: Axes) -> None:
    """One axis of distances for both, logarithmic if they are of several magnitudes."""
    distances = np.concatenate([line.get_xdata() for line in memory.lines])
    success.sharex(memory)
    success.tick_params(labelbottom=False)
    if distances.max() > WIDE * distances.min():
        memory.set_xscale("log")
        magnitudes(memory.xaxis)


def _sizes(axes: Axes) -> None:
    axes.set_yscale("symlog", base=2, linthresh=LEAST_MEMORY)
    axes.set_ylim(bottom=0)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda size, _: scaled(size, "bytes")))


def _unit(frames: Frames) -> str:
    kinds = [str(kind) for episodes in frames.values() for kind in episodes["kind"].unique()]
    return f"goal distance [{', '.join(dict.fromkeys(map(unit_of, kinds)))}]"
