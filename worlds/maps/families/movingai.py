"""Benchmark maps with their tasks: the Moving AI Lab's `.map` and `.scen` files."""

from functools import lru_cache
from pathlib import Path

import numpy as np

from fogbench.worlds.files import read, sha256
from fogbench.worlds.maps.files.octile import read_map, read_scen
from fogbench.worlds.maps.layout import CellConditions, CellMaps, Layout
from fogbench.worlds.settings import MapFile
from fogbench.worlds.streams import stream
from fogbench.worlds.types import MapError, World


class MovingAI(CellMaps):
    """One map and its list of tasks, each taken once, in an order shuffled by the contents of the list.

    A task counts if its 4-connected optimum is in the bounds; the lengths in the file are 8-connected and play no part.
    """

    map: MapFile
    """A `.map` file."""
    scen: MapFile | None = None
    """A `.scen` file; by default the map's path with `.scen` added."""

    def sample(self, rng: np.random.Generator, episode: int, conditions: CellConditions) -> World:
        """The world of the task of that number; no luck is needed.

        Raises:
            MapError: a file is broken, or has fewer tasks that fit.
        """
        del rng
        found = self._list(conditions).at(episode)
        if found is None:
            raise MapError(
                f"{self._scen()}: got episode {episode}, counted from 0; "
                f"expected at most {self.tasks(conditions)} episodes, the tasks with {conditions.wanted()}"
            )
        return found

    def words(self) -> str:
        """The digests of both files."""
        return f"MovingAI map={sha256(read(self.map))} scen={sha256(read(self._scen()))}"

    def tasks(self, conditions: CellConditions) -> int:
        """How many tasks fit the conditions; each one's optimum is computed once in a process."""
        return self._list(conditions).count()

    def _scen(self) -> Path:
        return self.scen or Path(f"{self.map}.scen")

    def _list(self, conditions: CellConditions) -> "TaskList":
        scen = self._scen()
        return _task_list(self.map, read(self.map), scen, read(scen), conditions)


class TaskList:
    """The tasks that fit, searched only as far as they are asked for."""

    def __init__(
        self, map_file: Path, map_text: bytes, scen_file: Path, scen_text: bytes, conditions: CellConditions
    ) -> None:
        """Read both files and shuffle the tasks."""
        layout = Layout(read_map(map_file, map_text))
        trips = read_scen(scen_file, scen_text, layout.blocked.shape)
        order = stream(0, sha256(scen_text), "order", 0).permutation(len(trips)).tolist()
        worlds = (conditions.world(layout, trips[k].start, trips[k].goal) for k in order)
        self.rest = (found for found in worlds if found is not None)
        self.found: list[World] = []

    def at(self, number: int) -> World | None:
        """The world of a task that fits, by its number from 0; None past the last."""
        while len(self.found) <= number:
            found = next(self.rest, None)
            if found is None:
                return None
            self.found.append(found)
        return self.found[number]

    def count(self) -> int:
        """How many tasks fit."""
        self.found.extend(self.rest)
        return len(self.found)


_task_list = lru_cache(maxsize=16)(TaskList)
