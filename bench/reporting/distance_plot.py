"""The plot against goal distance: success above, bytes carried below, on one axis."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from bench.reading.scenario import Scenario
from bench.reporting.curves import Bin, by_distance, distance_bins
from bench.reporting.panels import Look, Looks, legend, percent
from bench.reporting.tables import scaled

Frames = Mapping[str, pd.DataFrame]
"""The episodes of each variant."""

LENGTHS = {"grid": "cells", "graph": "edges", "robot": "m"}
"""The unit of length, by the kind of world."""

LEAST_MEMORY = 256
"""The axis of memory is logarithmic above, so that agents that carry nothing have a place too [bytes]."""

WIDE = 20
"""An axis of distances whose ends differ by this factor is logarithmic."""


def against_distance(frames: Frames, looks: Looks, scenario: Scenario) -> Figure:
    """Success with Wilson's interval as a band, and below it the most bytes carried from one decision to the next.

    Variants of one map family share their panels if their goals are ever farther away: no distance is in two of them.
    """
    joined = _joined(frames, scenario)
    figure = Figure(figsize=(1.9 + 2.4 * len(joined), 5.2), layout="constrained")
    rows = figure.subplots(2, len(joined), sharex="col", sharey="row", squeeze=False)  # [2, panels]
    for success, memory, names in zip(*rows, joined, strict=True):
        success.set_title(names[0] if len(names) == 1 else f"{names[0]} … {names[-1]}")
        for look, bins in _lines([frames[name] for name in names], looks):
            _draw(success, memory, look, bins)
        _scale(memory)
    _sizes(rows[1, 0])
    percent(rows[0, 0])
    rows[0, 0].set_ylabel("success [%]")
    rows[1, 0].set_ylabel("peak memory")
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
    success.fill_between(distance, shares[:, 1], shares[:, 2], color=look.color, alpha=0.12, linewidth=0)
    memory.plot(distance, [each.peak_memory for each in bins], clip_on=False, **look._asdict())


def _scale(axes: Axes) -> None:
    """A logarithmic axis if the distances are of several magnitudes."""
    distances = np.concatenate([line.get_xdata() for line in axes.lines])
    if distances.max() > WIDE * distances.min():
        axes.set_xscale("log")


def _sizes(axes: Axes) -> None:
    axes.set_yscale("symlog", base=2, linthresh=LEAST_MEMORY)
    axes.set_ylim(bottom=0)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda size, _: scaled(size, "bytes")))


def _unit(frames: Frames) -> str:
    kinds = dict.fromkeys(kind for episodes in frames.values() for kind in episodes["kind"].unique())
    return f"goal distance [{', '.join(LENGTHS.get(kind, kind) for kind in kinds)}]"
