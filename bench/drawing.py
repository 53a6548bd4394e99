"""Pixels of a moment, of the layers of its picture: the truth or the known map, view, path, agent and goal."""

import numpy as np
from PIL import Image, ImageDraw

from fogbench.worlds.picture import Cells, Dots, Layer, Lines, Picture, Squares
from fogbench.worlds.types import Array

COLOURS = np.array([[150, 150, 150], [255, 255, 255], [30, 30, 30]], np.uint8)  # [3, RGB]: unknown, free, blocked
LINE, VIEW, PATH, AGENT, GOAL = (30, 30, 30), (86, 180, 233), (0, 114, 178), (213, 94, 0), (0, 158, 115)
SIDE = 360
"""Least height of a picture [pixels]."""

TINT = 0.4
"""Share of a colour that lies over cells which stay to be seen."""

Colour = tuple[int, int, int]


def key(picture: Picture) -> dict[str, Colour]:
    """What each colour of a picture stands for: the readings of its cells or its lines, then its other layers."""
    below = (*picture.truth, *picture.known)
    readings = dict(zip(("unknown", "free", "blocked"), map(_colour, COLOURS), strict=True))
    names = readings if any(isinstance(layer, Cells) for layer in below) else {}
    if any(isinstance(layer, Lines | Dots) for layer in below):
        names = {**names, "map": LINE}
    view = VIEW if isinstance(picture.view, Lines | Dots) else _colour(tinted(COLOURS[1], VIEW, TINT))
    return {**names, "view": view, "path": PATH, "agent": AGENT, "goal": GOAL}


def tinted(pixels: Array, colour: Colour, share: float) -> Array:
    """[..., 3] uint8: pixels with a share of a colour over them."""
    return np.asarray((1 - share) * pixels + share * np.array(colour), np.uint8)


def _colour(pixel: Array) -> Colour:
    red, green, blue = pixel.tolist()
    return red, green, blue


def truth(picture: Picture) -> Array:
    """[h, w, 3] uint8: the world as it is, with what the sensor shows."""
    canvas = Canvas(picture)
    for layer in picture.truth:
        canvas.lay(layer, LINE)
    canvas.lay(picture.view, VIEW, share=TINT)
    return canvas.marked(picture)


def known(picture: Picture) -> Array:
    """[h, w, 3] uint8: the world as far as the agent had seen it."""
    canvas = Canvas(picture)
    for layer in picture.known:
        canvas.lay(layer, LINE)
    return canvas.marked(picture)


class Canvas:
    """Pixels, one for a cell, or as many for a unit of length as lines and dots need to be seen."""

    def __init__(self, picture: Picture) -> None:
        """An empty one for a picture."""
        layers = *picture.truth, *picture.known, *picture[3:]
        fine = any(isinstance(layer, Lines | Dots) for layer in layers)
        rows, columns = picture.extent
        self.scale = max(1, -(-SIDE // max(1, int(rows)))) if fine else 1
        self.pixels: Array = np.full((round(rows * self.scale), round(columns * self.scale), 3), 255, np.uint8)

    def lay(self, layer: Layer, colour: Colour, *, share: float = 1.0, reach: int = 0) -> None:
        """Draw a layer; a `share` below 1 tints cells, and `reach` draws so many cells around each."""
        match layer:
            case Cells(readings):
                self.pixels = COLOURS[readings].repeat(self.scale, 0).repeat(self.scale, 1)
            case Squares(at):
                for row, column in at.tolist():
                    self._fill(row, column, reach, colour, share)
            case Lines() | Dots():
                self._draw(layer, colour)

    def marked(self, picture: Picture) -> Array:
        """The pixels, with path, goal and agent; on large maps the last two are large, so that they are seen."""
        reach = int(picture.extent[0]) // 60
        self.lay(picture.path, PATH)
        self.lay(picture.goal, GOAL, reach=reach)
        self.lay(picture.agent, AGENT, reach=reach)
        return self.pixels

    def _fill(self, row: int, column: int, reach: int, colour: Colour, share: float) -> None:
        top, left = (max(0, at - reach) * self.scale for at in (row, column))
        block = self.pixels[top : (row + reach + 1) * self.scale, left : (column + reach + 1) * self.scale]
        block[:] = tinted(block, colour, share)

    def _draw(self, layer: Lines | Dots, colour: Colour) -> None:
        image, width = Image.fromarray(self.pixels), max(1, SIDE // 120)
        draw = ImageDraw.Draw(image)
        for points in ((layer[0] + 0.5) * self.scale).tolist():
            if isinstance(layer, Lines):
                (row, column), (end_row, end_column) = points
                draw.line((column, row, end_column, end_row), colour, width)
            else:
                row, column = points
                draw.circle((column, row), 2 * width, colour)
        self.pixels = np.array(image)
