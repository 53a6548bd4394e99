"""What a memory holds along an episode (Khan et al. 2018, figure 13)."""

from collections.abc import Mapping

import numpy as np

from fogbench.bench.reporting.canvas import Axes, Figure, Line2D
from fogbench.bench.reporting.panels import COLOURS, magnitudes, named
from fogbench.bench.reporting.plain import folded
from fogbench.bench.reporting.tables import Lines
from fogbench.worlds.types import Array

DASHES = ("--", ":", "-.")

WIDE = 120
"""Characters in a line of the title."""


def changes(held: Array) -> Array:
    """How far what is held [T, any] moves at each step: Euclidean [T]. Before the first it is zero."""
    return np.asarray(np.linalg.norm(np.diff(held, axis=0, prepend=0), axis=1))


def table(parts: Mapping[str, Array], marks: Mapping[str, int]) -> Lines:
    """How far each part moves at the median step, and at those that are marked; arguments as for `activations`."""
    moved = {name: changes(held) for name, held in parts.items()}
    rows = [[name, *(f"{x:.2g}" for x in (np.median(far), *far[list(marks.values())]))] for name, far in moved.items()]
    return Lines(["change of", "median step", *_named(marks)], rows)


def activations(parts: Mapping[str, Array], marks: Mapping[str, int], title: str) -> Figure:
    """A heat map over the steps for each part of what is held, and below how far each moves at each step.

    Args:
        parts: by name, the numbers of a part after each step: [T, any].
        marks: steps to mark, by name.
        title: one line.
    """
    marks = _together(marks)
    heights = [float(np.clip(held.shape[1] / 100, 1.2, 2.4)) for held in parts.values()]
    figure = Figure(figsize=(9, 2.6 + sum(heights)), layout="constrained")
    *maps, below = figure.subplots(len(parts) + 1, 1, sharex=True, height_ratios=[*heights, 1.8])
    for axes, (part, held) in zip(maps, parts.items(), strict=True):
        _heat(axes, held)
        axes.set_ylabel(part)
    maps[0].set_title(folded(title, WIDE), loc="left")
    _changes(below, parts)
    for axes in (*maps, below):
        axes.grid(visible=False)
        lines = _mark(axes, marks)
    if marks:
        named(figure, lines, _named(marks))
    return figure


def _together(marks: Mapping[str, int]) -> dict[str, int]:
    """The marks, those of one step under one name: a line would hide the other."""
    at: dict[int, list[str]] = {}
    for name, step in marks.items():
        at.setdefault(step, []).append(name)
    return {" and ".join(names): step for step, names in at.items()}


def _named(marks: Mapping[str, int]) -> list[str]:
    return [f"{name} (step {step})" for name, step in marks.items()]


def _mark(axes: Axes, marks: Mapping[str, int]) -> list[Line2D]:
    steps = zip(marks.values(), DASHES, strict=False)
    return [axes.axvline(step, color="black", linestyle=dashes) for step, dashes in steps]


def _heat(axes: Axes, held: Array) -> None:
    """A heat map of [T, any], a column for each step; zero is white, and numbers that are never negative are blue."""
    most = float(np.abs(held).max())
    colours, least = ("RdBu_r", -most) if held.min() < 0 else ("Blues", 0)
    picture = axes.imshow(held.T, colours, aspect="auto", interpolation="nearest", vmin=least, vmax=most)
    axes.set_yticks([])
    figure = axes.get_figure()
    assert figure is not None
    figure.colorbar(picture, ax=axes, pad=0.01)


def _changes(axes: Axes, parts: Mapping[str, Array]) -> None:
    for (part, held), colour in zip(parts.items(), COLOURS, strict=False):
        axes.plot(changes(held), color=colour, linewidth=1, label=part)
    axes.set(xlabel="step", ylabel="Euclidean change", yscale="log", xlim=(-0.5, len(held) - 0.5))
    magnitudes(axes.yaxis)
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=len(parts))
