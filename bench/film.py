"""A replay as one file: moments side by side as a PNG, every step as a GIF; both say what their colours stand for."""

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from fogbench.bench.drawing import SIDE, Colour
from fogbench.bench.reporting.canvas import Figure, Patch, draw
from fogbench.bench.reporting.panels import named
from fogbench.bench.reporting.plain import folded
from fogbench.worlds.files import write
from fogbench.worlds.types import Array

NAME = (72, 18)
"""Width and height of a name in a film [pixels]."""

Frame = tuple[Array, Array, int]
"""The truth and the known map, [h, w, 3] uint8 each; the step."""


def strip(moments: Sequence[Frame], names: Mapping[str, Colour], title: str, out: Path) -> None:
    """Draw moments side by side, the truth above the known map, as one PNG.

    Args:
        moments: at least one.
        names: what the colours stand for.
        title: one line.
        out: the file.

    Raises:
        Mistake: it cannot be drawn or written.
    """
    draw(partial(_strip, moments, names, title), out)


def _strip(moments: Sequence[Frame], names: Mapping[str, Colour], title: str) -> Figure:
    height, width = moments[0][0].shape[:2]
    size = 2.4 * max(2, len(moments)), 0.6 + 4.8 * height / width
    figure = Figure(figsize=size, layout="constrained", dpi=110)
    figure.suptitle(folded(title, 16 * max(2, len(moments))), fontsize=10)
    axes = figure.subplots(2, len(moments), squeeze=False)
    for column, (above, below, step) in enumerate(moments):
        for axis, picture, what in zip(axes[:, column], (above, below), ("truth", "known map"), strict=True):
            axis.imshow(picture, interpolation="nearest")
            axis.grid(visible=False)
            axis.spines[:].set_visible(True)
            axis.set(xticks=[], yticks=[], title=f"step {step}" if what == "truth" else "")
            axis.set_ylabel(what if column == 0 else "")
    patches = [Patch(facecolor="#{:02x}{:02x}{:02x}".format(*colour), edgecolor="gray") for colour in names.values()]
    named(figure, patches, list(names), "lower")
    return figure


def film(pictures: Iterable[Frame], names: Mapping[str, Colour], out: Path) -> None:
    """Draw every step as one GIF, the truth beside the known map, and below what the colours stand for.

    Raises:
        OSError: it cannot be written.
    """
    frames = [_frame(above, below, names) for above, below, _ in pictures]
    contents = BytesIO()
    frames[0].save(contents, "GIF", save_all=True, append_images=frames[1:], duration=80, loop=0)
    write(out, contents.getbuffer())


def _frame(left: Array, right: Array, names: Mapping[str, Colour]) -> Image.Image:
    gap = np.full((len(left), 1, 3), 255, np.uint8)  # [H, 1, 3]
    both = Image.fromarray(np.concatenate([left, gap, right], axis=1))  # [H, 2 * W + 1, 3]
    scale = max(1, -(-SIDE // len(left)))
    large = both.resize((both.width * scale, both.height * scale), Image.Resampling.NEAREST)
    below = _key(names, large.width)
    frame = Image.new("RGB", (large.width, large.height + below.height), "white")
    frame.paste(large)
    frame.paste(below, (0, large.height))
    return frame.quantize(64)


def _key(names: Mapping[str, Colour], width: int) -> Image.Image:
    """What the colours stand for, in as many rows as a picture of some width needs."""
    wide, high = NAME
    columns = max(1, width // wide)
    image = Image.new("RGB", (width, high * -(-len(names) // columns)), "white")
    pen = ImageDraw.Draw(image)
    for number, (name, colour) in enumerate(names.items()):
        x, y = number % columns * wide + 4, number // columns * high + 4
        pen.rectangle((x, y, x + 10, y + 10), colour, "gray")
        pen.text((x + 16, y - 1), name, "black")
    return image
