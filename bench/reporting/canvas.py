"""The one door to Matplotlib: imported and used under our own settings, whatever a user's environment or plug-ins say.

Figures are made without pyplot, so nothing global is touched and no window is ever opened.
"""

import logging
import os
import warnings
from collections.abc import Callable, Iterator
from contextlib import chdir, contextmanager
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import Any

from fogbench.worlds.files import write
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.reading.blocks import raised

__all__ = [
    "STYLE", "Artist", "Axes", "Axis", "Figure", "FuncFormatter", "Line2D", "LineStyleType", "LogFormatter", "Patch",
    "draw", "ours",
]  # fmt: skip


@contextmanager
def _quiet() -> Iterator[None]:
    """What a library warns of concerns nobody who looks at a plot."""
    log = logging.getLogger("matplotlib")
    level = log.level
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        log.setLevel(logging.CRITICAL)
        try:
            yield
        finally:
            log.setLevel(level)


@contextmanager
def _unadvised() -> Iterator[None]:
    """Matplotlib reads a settings file where it is imported, and the name of a backend: it finds its own, and none."""
    spec, backend = find_spec("matplotlib"), os.environ.pop("MPLBACKEND", None)
    own = Path(spec.origin).with_name("mpl-data") if spec and spec.origin else Path()
    try:
        with chdir(own if own.is_dir() else "."):
            yield
    finally:
        if backend is not None:
            os.environ["MPLBACKEND"] = backend


try:
    with _unadvised(), _quiet():
        import matplotlib as mpl
    with _quiet():
        from matplotlib.artist import Artist
        from matplotlib.axes import Axes
        from matplotlib.axis import Axis
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from matplotlib.lines import Line2D
        from matplotlib.patches import Patch
        from matplotlib.ticker import FuncFormatter, LogFormatter
        from matplotlib.typing import LineStyleType
except Exception as error:
    raise Mistake(f"Matplotlib: got {raised(error)}; expected it to load: nothing is drawn.") from error

STYLE: dict[Any, Any] = {
    "figure.dpi": 200,
    "font.size": 9,
    "text.parse_math": False,
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
"""How all plots look; a dollar in a label is a dollar."""


@contextmanager
def ours() -> Iterator[None]:
    """Matplotlib as we set it; afterwards it is as it was."""
    usual: dict[Any, Any] = {name: value for name, value in mpl.rcParamsDefault.items() if name != "backend"}
    with _quiet(), mpl.rc_context({**usual, **STYLE}):
        yield


def draw(make: Callable[[], Figure], path: Path) -> None:
    """Make a figure, and write it as a PNG, whole or not at all.

    Raises:
        Mistake: it cannot be drawn or written.
    """
    contents = BytesIO()
    try:
        with ours():
            canvas: Any = FigureCanvasAgg(make())
            canvas.print_png(contents)  # `savefig` draws a figure twice
        write(path, contents.getvalue())
    except Exception as error:
        raise Mistake(f"{path}: got {raised(error)}; expected a plot that can be drawn and written.") from error
