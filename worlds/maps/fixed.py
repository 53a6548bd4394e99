"""A task that a scenario fixes on a map of cells, and why a task does not fit."""

import numpy as np

from fogbench.worlds.maps.cells import passable
from fogbench.worlds.maps.distances import FAR, distances
from fogbench.worlds.maps.layout import CellConditions, Layout
from fogbench.worlds.mistake import counted
from fogbench.worlds.types import Array, Cell, MapError, World

ONE_TASK = "all episodes are one and the same task: intervals and tests tell of luck alone, not of other tasks"
"""What a user should know whose scenario fixes the task."""


def both_or_neither(start: object, goal: object) -> None:
    """Hold it against a family that only half of its task is fixed.

    Raises:
        ValueError: one of them is None.
    """
    if (start is None) != (goal is None):
        raise ValueError("start and goal, or neither")


ENDS = ("start", "goal")


def fixed(
    map_: str, blocked: Array, start: Cell, goal: Cell, conditions: CellConditions, ends: tuple[str, str] = ENDS
) -> World:
    """The world of a fixed task.

    Args:
        map_: what the map is called in errors.
        blocked: [H, W] bool.
        start: may lie outside of the map, as `goal`.
        goal: of the task.
        conditions: of the scenario.
        ends: what start and goal are called in errors.

    Raises:
        MapError: the task does not fit; the text says which end of it, and why.
    """
    inside = all(0 <= n < side for cell in (start, goal) for n, side in zip(cell, blocked.shape, strict=True))
    world = conditions.world(Layout(blocked), start, goal) if inside else None
    if world is None:
        told = misplaced(blocked, start, goal, ends) or [unreached(blocked, start, goal, conditions, ends[1])]
        raise MapError("\n".join(f"{map_}: {line}" for line in told))
    return world


def misfit(blocked: Array, start: Cell, goal: Cell, conditions: CellConditions) -> str:
    """Why a task does not fit its map [H, W] or the conditions, in words for an error."""
    return next(iter(misplaced(blocked, start, goal)), "") or unreached(blocked, start, goal, conditions)


def misplaced(blocked: Array, start: Cell, goal: Cell, ends: tuple[str, str] = ENDS) -> list[str]:
    """Which ends of a task are outside of its map [H, W] or on an obstacle."""
    (height, width), lines = blocked.shape, list[str]()
    for name, (row, column) in zip(ends, (start, goal), strict=True):
        place, rows = f"{name} [{row}, {column}]", f"a row from 0 to {height - 1} and a column from 0 to {width - 1}"
        if not (0 <= row < height and 0 <= column < width):
            lines.append(f"{place}: got a cell outside of the map; expected {rows}")
        elif not passable(blocked, row, column):
            lines.append(f"{place}: got an obstacle; expected a free cell")
    return lines


def unreached(blocked: Array, start: Cell, goal: Cell, conditions: CellConditions, end: str = "goal") -> str:
    """Why a task does not fit whose ends are free cells of its map."""
    place = f"{end} {list(goal)}"
    if start == goal:
        return f"{place}: got the cell of the start; expected another one"
    cells = int(distances(np.asarray(blocked), start, goal)[goal])
    if cells == FAR:
        return f"{place}: no path leads here from the start {list(start)}"
    way = f"a shortest path of {counted(cells, 'cell')} from the start {list(start)}"
    return f"{place}: got {way}; expected {conditions.wanted()}"
