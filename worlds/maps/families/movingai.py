"""Benchmark maps with their tasks: the Moving AI Lab's `.map` and `.scen` files."""

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path, PureWindowsPath

import numpy as np
from pydantic import model_validator

from fogbench.worlds.files import Loaded, load
from fogbench.worlds.maps.files.mistakes import refuse
from fogbench.worlds.maps.files.octile import read_map
from fogbench.worlds.maps.files.scen import Trip, read_scen
from fogbench.worlds.maps.fixed import ONE_TASK, both_or_neither, fixed, misfit
from fogbench.worlds.maps.layout import CellConditions, CellMaps, Layout
from fogbench.worlds.mistake import counted
from fogbench.worlds.reading.positions import Fault
from fogbench.worlds.settings import Count, MapFile
from fogbench.worlds.streams import stream
from fogbench.worlds.types import MapError, World


class MovingAI(CellMaps):
    """One map and its list of tasks, each taken once, in an order shuffled by the contents of the list.

    A task counts if its 4-connected optimum is in the bounds; the lengths in the file are 8-connected and play no part.
    A list may name the map otherwise than the file is called, in any folder and case, as long as its tasks lie on free
    cells; then `fogbench check` and `fogbench run` say so.
    """

    map: MapFile
    """A `.map` file."""
    scen: MapFile | None = None
    """A `.scen` file; by default the map's path with `.scen` added."""
    start: tuple[Count, Count] | None = None
    """`[row, column]` from 0, with `goal` in place of a list: the task of every episode."""
    goal: tuple[Count, Count] | None = None
    """`[row, column]` from 0."""

    @model_validator(mode="after")
    def _one_task_or_a_list(self) -> "MovingAI":
        both_or_neither(self.start, self.goal)
        if self.scen and self.start:
            raise ValueError("scen, or start and goal; not both")
        return self

    def sample(self, rng: np.random.Generator, episode: int, conditions: CellConditions) -> World:
        """The world of the task of that number; no luck is needed.

        Raises:
            MapError: a file is broken, has fewer tasks that fit, or the fixed task does not.
        """
        del rng
        if self.start and self.goal:
            return fixed(str(self.map), _layout(load(self.map)).blocked, self.start, self.goal, conditions)
        tasks = self._list(conditions)
        found = tasks.at(episode)
        if found is None:
            raise MapError(f"{self._scen()}: {tasks.shortage(episode + 1)}")
        return found

    def words(self) -> str:
        """The digests of both files, or that of the map and the fixed task."""
        told = f"start={self.start} goal={self.goal}" if self.start else f"scen={load(self._scen()).sha256}"
        return f"MovingAI map={load(self.map).sha256} {told}"

    def tasks(self, conditions: CellConditions, most: int) -> int | None:
        """How many tasks of the list fit the conditions; each one's optimum is computed once in a process."""
        return None if self.start else self._list(conditions).count(most)

    def notes(self) -> Sequence[str]:
        """Whether the task is fixed, or else the list names another map, and which of its tasks lie on obstacles."""
        if self.start:
            return [f"{self.map}: {ONE_TASK}"]
        layout, trips = _files(load(self.map), load(self._scen()))
        strange, stuck = _strange(trips, self.map), [trip for trip in trips if _stuck(trip, layout)]
        notes = []
        if strange:
            notes.append(f"{len(strange)} tasks of {strange[0].map} are played on {self.map.name}")
        if stuck:
            first = f"the first on line {stuck[0].line}"
            notes.append(f"{len(stuck)} of {len(trips)} tasks lie on obstacles and are left out, {first}")
        return [f"{self._scen()}: {note}" for note in notes]

    def _scen(self) -> Path:
        """The list of tasks.

        Raises:
            MapError: the settings name none, and none is beside the map.
        """
        beside = Path(f"{self.map}.scen")
        if self.scen is None and not beside.exists():
            raise MapError(f"{beside}: no such file; give a list by `scen`, or one task by `start` and `goal`")
        return self.scen or beside

    def _list(self, conditions: CellConditions) -> "TaskList":
        return _task_list(load(self.map), load(self._scen()), conditions)


class TaskList:
    """The tasks that fit, searched only as far as they are asked for."""

    def __init__(self, map_file: Loaded, scen: Loaded, conditions: CellConditions) -> None:
        """Shuffle the tasks of a list."""
        self.layout, self.trips = _files(map_file, scen)
        self.conditions = conditions
        order = stream(0, scen.sha256, "order", 0).permutation(len(self.trips)).tolist()
        self.rest = iter([self.trips[k] for k in order])
        self.found: list[World] = []
        self.unfit: list[Trip] = []

    def at(self, number: int) -> World | None:
        """The world of a task that fits, by its number from 0; None past the last."""
        return self.found[number] if self.count(number + 1) > number else None

    def count(self, most: int) -> int:
        """How many tasks fit, of which no more than `most` are looked for."""
        while len(self.found) < most and (trip := next(self.rest, None)):
            world = self.conditions.world(self.layout, trip.start, trip.goal)
            if world is None:
                self.unfit.append(trip)
            else:
                self.found.append(world)
        return min(len(self.found), most)

    def shortage(self, wanted: int) -> str:
        """Why there are not as many tasks as wanted, after all were looked at."""
        fit, total = len(self.found), len(self.trips)
        if not self.unfit:
            lacking = f"{counted(total, 'task')} for {counted(wanted, 'episode')}"
            return f"{lacking}; set `episodes: {total}`, or give more tasks"
        first = min(self.unfit)
        why = misfit(self.layout.blocked, first.start, first.goal, self.conditions)
        tasks, are = counted(total, "task"), "is" if fit == 1 else "are"
        usable = f"only {fit} of {tasks} {are} usable, for {wanted} episodes" if fit else f"none of {tasks} is usable"
        return f"{usable}: line {first.line}: {why}"


_task_list = lru_cache(maxsize=16)(TaskList)


@lru_cache(maxsize=16)
def _layout(map_file: Loaded) -> Layout:
    return Layout(read_map(map_file.path, map_file.contents))


@lru_cache(maxsize=16)
def _files(map_file: Loaded, scen: Loaded) -> tuple[Layout, tuple[Trip, ...]]:
    """A map and its list of tasks.

    Raises:
        MapError: all that is wrong with both, or the list is another map's.
    """
    try:
        layout = _layout(map_file)
    except MapError as error:
        try:
            read_scen(scen.path, scen.contents, None)
        except MapError as more:
            raise MapError(f"{error}\n{more}") from None
        raise
    trips = read_scen(scen.path, scen.contents, layout.blocked.shape)
    strange = _strange(trips, map_file.path)
    stuck = sum(_stuck(trip, layout) for trip in strange)
    if stuck:
        got = f"{len(strange)} tasks of {strange[0].map}, {stuck} of them on obstacles of {map_file.path.name}"
        expected = f"tasks of {map_file.path.name} (name another list by scen, or this map in the list)"
        refuse(scen.path, [Fault(strange[0].line, 1, "", got, expected)])
    return layout, trips


def _strange(trips: Sequence[Trip], path: Path) -> list[Trip]:
    """The tasks that name another map, whatever its folder and its case."""
    own = {name for name in {trip.map for trip in trips} if _plain(name) == _plain(path.name)}
    return [trip for trip in trips if trip.map not in own]


def _plain(name: str) -> str:
    return PureWindowsPath(name).name.casefold().removesuffix(".map")


def _stuck(trip: Trip, layout: Layout) -> bool:
    return bool(layout.blocked[trip.start] or layout.blocked[trip.goal])
