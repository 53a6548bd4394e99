"""Floor maps as robots record them: the YAML and the image of ROS's map_server."""

from collections.abc import Sequence
from functools import lru_cache
from math import cos, floor, sin
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from fogbench.worlds.files import Loaded, load
from fogbench.worlds.maps.files.image import read_image
from fogbench.worlds.maps.files.map_server import SAVED_UNKNOWN, Header, occupancy, read_header
from fogbench.worlds.maps.fixed import ONE_TASK, both_or_neither, fixed
from fogbench.worlds.maps.layout import CellConditions, CellMaps, Layout, fit
from fogbench.worlds.settings import Count, MapFile, Settings
from fogbench.worlds.types import Array, Cell, MapError, World

TRIES = 100
"""Times that `fogbench.worlds.maps.layout.fit` looks for a task before the map is said to have none."""

Metres = Annotated[float, Field(ge=-1e6, le=1e6)]


class Point(Settings):
    """A place on a floor, in the frame of its `origin`."""

    x: Metres
    """[m]"""
    y: Metres
    """[m]"""


def _form(place: Any) -> str:
    return "metres" if isinstance(place, dict | Point) else "cells"


Place = Annotated[Annotated[tuple[Count, Count], Tag("cells")] | Annotated[Point, Tag("metres")], Discriminator(_form)]
"""`[row, column]` from 0, of the map as it is played, or `{x: ..., y: ...}` in metres."""


class Occupancy(CellMaps):
    """One recorded map; start and goal are uniform over its free cells. What was never seen is blocked.

    PGM, PPM, PNG and BMP images are read as map_server reads them, in all its modes. What it calls neither free nor
    occupied is blocked. One thing is read otherwise: grey 205, which map_saver writes for unknown cells, is unknown in
    mode trinary even where free_thresh is above its 0.196, as in the files that map_saver of ROS 2 writes; then
    `fogbench check` and `fogbench run` say so. The map is cropped to the smallest rectangle that holds all known cells.
    """

    map: MapFile
    """A `.yaml` file; it names the image."""
    downsample: Annotated[int, Field(ge=1, le=1000)] = 1
    """Side of the square of image cells that makes one cell of the map, blocked if any of them is."""
    start: Place | None = None
    """With `goal`, the task of every episode: `[row, column]` from 0 of the cropped, downsampled map, or
    `{x: ..., y: ...}` [m], by the resolution and the origin in the file."""
    goal: Place | None = None
    """As `start`."""

    @model_validator(mode="after")
    def _whole_task(self) -> "Occupancy":
        both_or_neither(self.start, self.goal)
        return self

    def sample(self, rng: np.random.Generator, episode: int, conditions: CellConditions) -> World:
        """A task that fits the conditions; `episode` plays no part.

        Raises:
            MapError: a file is broken, no task was found, or the fixed one does not fit.
        """
        del episode
        header, image = self._files()
        floor_ = _floor(image, header, self.downsample)
        if self.start and self.goal:
            start, goal = (_cell(place, floor_, header, self.downsample) for place in (self.start, self.goal))
            ends = (_told("start", self.start), _told("goal", self.goal))
            return fixed(str(self.map), floor_.blocked, start, goal, conditions, ends)
        for _ in range(TRIES):
            found = fit(Layout(floor_.blocked), conditions, rng)
            if found is not None:
                return found
        raise MapError(f"{self.map}: no task with {conditions.wanted()} was found")

    def words(self) -> str:
        """The digests of both files, the downsampling, and the fixed task."""
        _, image = self._files()
        task = f" start={self.start} goal={self.goal}" if self.start else ""
        return f"Occupancy map={load(self.map).sha256} image={image.sha256} downsample={self.downsample}{task}"

    def notes(self) -> Sequence[str]:
        """How many cells are blocked that map_server might call free, and whether the task is fixed."""
        header, image = self._files()
        told = _floor(image, header, self.downsample)
        notes = []
        if told.saved:
            why = f"which map_saver writes for unknown, though free_thresh {header.free_thresh:g} calls them free"
            notes.append(f"{told.saved} cells of grey {SAVED_UNKNOWN} are blocked, {why}")
        if told.between:
            notes.append(f"{told.between} cells between free_thresh and occupied_thresh are blocked")
        if self.start:
            notes.append(ONE_TASK)
        return [f"{image.path}: {note}" for note in notes]

    def _files(self) -> tuple[Header, Loaded]:
        header = _header(load(self.map))
        return header, load(header.image)


class Floor(NamedTuple):
    """A map, cropped and coarsened, and what it was made of."""

    blocked: Array
    """[H, W] bool, read-only."""
    height: int
    """Rows of the image."""
    top: int
    """Rows of the image that were cut off above."""
    left: int
    """Columns of the image that were cut off to the left."""
    saved: int
    between: int
    """Cells of the image; see `fogbench.worlds.maps.files.map_server.Readings`."""


@lru_cache(maxsize=16)
def _header(file: Loaded) -> Header:
    return read_header(file.path, file.contents)


@lru_cache(maxsize=16)
def _floor(image: Loaded, header: Header, downsample: int) -> Floor:
    """The map of an image."""
    free, occupied, saved, between = occupancy(read_image(image.path, image.contents), header)
    known = free | occupied
    if not known.any():
        raise MapError(f"{image.path}: got only unknown cells; expected some that are free")
    rows, columns = np.flatnonzero(known.any(1)), np.flatnonzero(known.any(0))
    top, left = int(rows[0]), int(columns[0])
    blocked = _coarse(~free[top : rows[-1] + 1, left : columns[-1] + 1], downsample)
    blocked.setflags(write=False)
    return Floor(blocked, len(free), top, left, saved, between)


def _coarse(blocked: Array, side: int) -> Array:
    """A cell for each square of `side` cells; what sticks out over the border is blocked."""
    height, width = blocked.shape
    padded = np.pad(blocked, ((0, -height % side), (0, -width % side)), constant_values=True)
    rows, columns = padded.shape[0] // side, padded.shape[1] // side
    squares: Array = padded.reshape(rows, side, columns, side)
    return np.asarray(squares.any((1, 3)))  # [rows, columns]


def _cell(place: Point | Cell, floor_: Floor, header: Header, downsample: int) -> Cell:
    """The cell of a place; it may lie outside of the map."""
    if not isinstance(place, Point):
        return place
    x, y, yaw = header.origin
    east, north = place.x - x, place.y - y
    right, up = east * cos(yaw) + north * sin(yaw), north * cos(yaw) - east * sin(yaw)
    row = floor_.height - 1 - _count(up, header.resolution) - floor_.top
    return row // downsample, (_count(right, header.resolution) - floor_.left) // downsample


def _told(end: str, place: Point | Cell) -> str:
    """What an end of a task is called in errors, before its cell."""
    return f"{end} {{x: {place.x:g}, y: {place.y:g}}}, cell" if isinstance(place, Point) else end


def _count(metres: float, resolution: float) -> int:
    """Whole pixels, at most a billion; a place on the line between two is in the upper or right one."""
    return floor(min(max(metres / resolution + 1e-6, -1e9), 1e9))
