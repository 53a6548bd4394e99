"""Test error and success on held-out maps as a network learns (Khan et al. 2018, figure 11)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

from fogbench.bench.reporting.panels import STYLE, look_of


def write_curves(trials: Sequence[Mapping[str, Any]], folder: Path) -> None:
    """Write `learning.png`; `trials` are lines of the log of a training."""
    with rc_context(STYLE):
        curves(trials).savefig(folder / "learning.png", dpi=200)


def curves(trials: Sequence[Mapping[str, Any]]) -> Figure:
    """A panel for test error and one for success, against batches, with one line for each variant."""
    figure = Figure(figsize=(9, 3.2), layout="constrained")
    batches = [trial["batch"] for trial in trials]
    for axes, metric in zip(figure.subplots(1, 2), ("test_error", "success"), strict=True):
        for k, variant in enumerate(trials[0]["variants"]):
            reached = [trial["variants"][variant][metric] for trial in trials]
            axes.plot(batches, reached, label=variant, markersize=3, **look_of(k)._asdict())
        axes.set_xlabel("batches")
        axes.set_ylabel(f"{metric.replace('_', ' ')} on held-out maps [%]")
        axes.set_ylim(bottom=0)
    axes.legend()
    return figure
