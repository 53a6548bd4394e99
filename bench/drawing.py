"""Pictures of a replay: the truth beside the known map, with view, path, agent and goal."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from fogbench.bench.playing.replay import Moment
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array, Cell

COLOURS = np.array([[150, 150, 150], [255, 255, 255], [30, 30, 30]], np.uint8)  # [3, RGB]: unknown, free, blocked
VIEW, PATH, AGENT, GOAL = (86, 180, 233), (0, 114, 178), (213, 94, 0), (0, 158, 115)
SIDE = 360
"""Least height of a picture [pixels]."""


def truth(moment: Moment) -> Array:
    """[H, W, 3] uint8: the map as it is, the cells that the sensor shows tinted."""
    cells = np.where(moment.world.blocked, BLOCKED, FREE)  # [H, W]
    picture = COLOURS[cells]  # [H, W, 3]
    view = moment.observation.view
    seen = np.argwhere(view != UNKNOWN) + moment.observation.place - len(view) // 2  # [n, 2]
    rows, columns = seen[((seen >= 0) & (seen < cells.shape)).all(axis=1)].T  # [m], [m]
    picture[rows, columns] = (0.6 * picture[rows, columns] + 0.4 * np.array(VIEW)).astype(np.uint8)
    return _mark(picture, moment)


def known(moment: Moment) -> Array:
    """[H, W, 3] uint8: the map as far as the agent had seen it."""
    return _mark(COLOURS[moment.known], moment)


def strip(moments: Sequence[tuple[Array, Array, int]], title: str, out: Path) -> None:
    """Draw moments side by side, the truth above the known map, as one PNG.

    Args:
        moments: picture of the truth, picture of the known map, step.
        title: one line.
        out: the file.
    """
    height, width = moments[0][0].shape[:2]
    figure = Figure(figsize=(2.4 * len(moments), 0.6 + 4.8 * height / width), layout="constrained", dpi=110)
    figure.suptitle(title, fontsize=10)
    axes = figure.subplots(2, len(moments), squeeze=False)
    for column, (above, below, step) in enumerate(moments):
        for axis, picture, what in zip(axes[:, column], (above, below), ("truth", "known map"), strict=True):
            axis.imshow(picture, interpolation="nearest")
            axis.set(xticks=[], yticks=[], title=f"step {step}" if what == "truth" else "")
            axis.set_ylabel(what if column == 0 else "")
    figure.savefig(out)


def film(pictures: Iterable[tuple[Array, Array, int]], out: Path) -> None:
    """Draw every step as one GIF, the truth beside the known map."""
    frames = [_frame(above, below) for above, below, _ in pictures]
    frames[0].save(out, save_all=True, append_images=frames[1:], duration=80, loop=0)


def _mark(picture: Array, moment: Moment) -> Array:
    rows, columns = np.array(moment.path).T  # [n], [n]
    picture[rows, columns] = PATH
    picture[_around(moment.world.task.goal, picture)] = GOAL
    picture[_around(moment.observation.place, picture)] = AGENT
    return picture


def _around(cell: Cell, picture: Array) -> tuple[slice, slice]:
    """A cell, on large maps with the cells around it, so that it is seen."""
    row, column = cell
    reach = len(picture) // 60
    return np.s_[max(0, row - reach) : row + reach + 1, max(0, column - reach) : column + reach + 1]


def _frame(left: Array, right: Array) -> Image.Image:
    gap = np.full((len(left), 1, 3), 255, np.uint8)  # [H, 1, 3]
    both = Image.fromarray(np.concatenate([left, gap, right], axis=1))  # [H, 2 * W + 1, 3]
    scale = max(1, -(-SIDE // len(left)))
    return both.resize((both.width * scale, both.height * scale), Image.Resampling.NEAREST).quantize(64)
