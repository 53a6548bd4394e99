"""Floor maps as robots record them: the YAML and the image of ROS's map_server."""

from functools import lru_cache
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from fogbench.worlds.files import read, sha256
from fogbench.worlds.maps.files.map_server import Header, occupancy, read_header, read_image
from fogbench.worlds.maps.layout import CellConditions, CellMaps, Layout, fit
from fogbench.worlds.settings import MapFile
from fogbench.worlds.types import Array, MapError, World

TRIES = 100
"""Times that `fogbench.worlds.maps.layout.fit` looks for a task before the map is said to have none."""


class Occupancy(CellMaps):
    """One recorded map; start and goal are uniform over its free cells. What was never seen is blocked.

    The map is cropped to the smallest rectangle that holds all known cells.
    """

    map: MapFile
    """A `.yaml` file; it names the image."""
    downsample: Annotated[int, Field(ge=1, le=1000)] = 1
    """Side of the square of image cells that makes one cell of the map, blocked if any of them is."""

    def sample(self, rng: np.random.Generator, episode: int, conditions: CellConditions) -> World:
        """A task that fits the conditions; `episode` plays no part.

        Raises:
            MapError: a file is broken, or no task was found.
        """
        del episode
        header, image = self._files()
        layout = Layout(_grid(image, read(image), header, self.downsample))
        for _ in range(TRIES):
            found = fit(layout, conditions, rng)
            if found is not None:
                return found
        raise MapError(f"{self.map}: no task with {conditions.wanted()} was found")

    def words(self) -> str:
        """The digests of both files, and the downsampling."""
        _, image = self._files()
        return f"Occupancy map={sha256(read(self.map))} image={sha256(read(image))} downsample={self.downsample}"

    def _files(self) -> tuple[Header, Path]:
        header = read_header(self.map, read(self.map))
        return header, self.map.parent / header.image


@lru_cache(maxsize=16)
def _grid(path: Path, contents: bytes, header: Header, downsample: int) -> Array:
    """The map of an image, cropped and coarsened: [H, W] bool, True where blocked, read-only."""
    free, occupied = occupancy(read_image(path, contents), header)
    known = np.argwhere(free | occupied)  # [n, 2]
    if not len(known):
        raise MapError(f"{path}: got only unknown cells; expected some that are free")
    (top, left), (bottom, right) = known.min(0), known.max(0) + 1
    blocked = _coarse(~free[top:bottom, left:right], downsample)
    blocked.setflags(write=False)
    return blocked


def _coarse(blocked: Array, side: int) -> Array:
    """A cell for each square of `side` cells; what sticks out over the border is blocked."""
    height, width = blocked.shape
    padded = np.pad(blocked, ((0, -height % side), (0, -width % side)), constant_values=True)
    rows, columns = padded.shape[0] // side, padded.shape[1] // side
    squares: Array = padded.reshape(rows, side, columns, side)
    return np.asarray(squares.any((1, 3)))  # [rows, columns]
