"""Test error and success on held-out maps as a network learns (Khan et al. 2018, figure 11)."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from fogbench.bench.reporting.canvas import Figure, draw
from fogbench.bench.reporting.panels import look_of, named

SHOWN = {"test_error": "test error on held-out maps", "success": "success on held-out maps [%]"}
"""What is shown of a trial, and what stands beside it."""


def write_curves(trials: Sequence[Mapping[str, Any]], folder: Path) -> None:
    """Write `learning.png`; `trials` are lines of the log of a training.

    Raises:
        Mistake: it cannot be drawn or written.
    """
    draw(partial(curves, trials), folder / "learning.png")


def curves(trials: Sequence[Mapping[str, Any]]) -> Figure:
    """A panel for test error and one for success, against batches, with one line for each variant."""
    figure = Figure(figsize=(9, 3.2), layout="constrained")
    batches, variants = [trial["batch"] for trial in trials], list(trials[0]["variants"])
    for axes, (metric, shown) in zip(figure.subplots(1, 2), SHOWN.items(), strict=True):
        for k, variant in enumerate(variants):
            reached = [trial["variants"][variant][metric] for trial in trials]
            axes.plot(batches, reached, markersize=3, **look_of(k)._asdict())
        axes.set_xlabel("batches")
        axes.set_ylabel(shown)
        axes.set_ylim(bottom=0)
    named(figure, axes.lines, variants)
    return figure
