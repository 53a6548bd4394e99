"""Benchmark maps with their tasks."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.movingai import MovingAI
from fogbench.worlds.maps.fixed import ONE_TASK
from fogbench.worlds.types import Cell, MapError

MAP = "type octile\nheight 2\nwidth 30\nmap\n" + "." * 30 + "\n" + "." * 29 + "@\n"
RNG = np.random.default_rng(0)


def conditions(least: int, most: int) -> GridConditions:
    """Conditions with bounds of the optimum."""
    return GridConditions.model_validate({"budget": {"steps": 100}, "tasks": {"distance": [least, most]}})


def family(folder: Path, **fields: Any) -> MovingAI:
    """A corridor with a task from its left end to each of its cells, then one to a blocked cell, in a fresh folder."""
    folder.mkdir(parents=True, exist_ok=True)
    goals = [(x, 0) for x in range(30)] + [(29, 1)]
    lines = [f"0\tx.map\t30\t2\t0\t0\t{x}\t{y}\t{x}" for x, y in goals]
    (folder / "x.map").write_text(MAP)
    (folder / "x.map.scen").write_text("\n".join(["version 1", *lines]))
    return MovingAI(map=folder / "x.map", **fields)


def goals(maps: MovingAI, under: GridConditions, count: int) -> list[Cell]:
    """The goals of the first episodes."""
    return [maps.sample(RNG, episode, under).task.goal for episode in range(count)]


def test_every_fitting_task_is_taken_once(tmp_path: Path) -> None:
    """The episodes are the tasks whose optimum is in the bounds, each once; the blocked goal never."""
    maps = family(tmp_path)
    assert maps.tasks(conditions(5, 12), 100) == 8
    assert sorted(goals(maps, conditions(5, 12), 8)) == [(0, column) for column in range(5, 13)]
    assert maps.tasks(conditions(1, 100), 100) == 29
    assert maps.tasks(conditions(50, 100), 100) == 0


def test_the_order_hangs_on_the_contents_alone(tmp_path: Path) -> None:
    """The order is not the file's; it is the same in another folder, and in whatever order episodes are asked for."""
    here, there = family(tmp_path / "here"), family(tmp_path / "there")
    order = goals(here, conditions(1, 100), 29)
    assert order != sorted(order)
    assert goals(there, conditions(1, 100), 29) == order
    for episode in (28, 3, 0):
        assert here.sample(RNG, episode, conditions(1, 100)).task.goal == order[episode]


def test_episodes_share_one_read_only_map(tmp_path: Path) -> None:
    """The map is read once, and nobody can change it."""
    maps = family(tmp_path)
    first, second = (maps.sample(RNG, episode, conditions(1, 100)).blocked for episode in (0, 1))
    assert first is second
    assert not first.flags.writeable


def test_no_more_tasks_are_searched_than_needed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Three episodes with all but two tasks fitting cost at most five searches; asking again costs none."""
    searched = []

    def counted(*arguments: Any) -> Any:
        searched.append(arguments)
        return world(*arguments)

    world = GridConditions.world
    monkeypatch.setattr(GridConditions, "world", counted)
    maps = family(tmp_path)
    for episode in (2, 0, 1, 2):
        maps.sample(RNG, episode, conditions(1, 100))
    assert maps.tasks(conditions(1, 100), 3) == 3
    assert 3 <= len(searched) <= 5


def test_words_hold_the_contents_and_not_the_place(tmp_path: Path) -> None:
    """The words are equal for equal files anywhere, and differ when a byte of either file does."""
    here, there = family(tmp_path / "here"), family(tmp_path / "there")
    assert here.words() == there.words()
    assert here.words().startswith("MovingAI map=")
    same = MovingAI(map=tmp_path / "here/x.map", scen=tmp_path / "there/x.map.scen")
    assert same.words() == here.words()
    (tmp_path / "here/x.map").write_text(MAP.replace("@", "T"))
    (tmp_path / "there/x.map.scen").write_text("version 1\n")
    assert len({here.words(), there.words(), same.words()}) == 3
    assert there.tasks(conditions(1, 100), 100) == 0


def test_an_episode_past_the_last_task_is_one_line(tmp_path: Path) -> None:
    """The error says how many tasks there are, and which is the first that does not fit, and why."""
    with pytest.raises(MapError) as error:
        family(tmp_path).sample(RNG, 8, conditions(5, 12))
    assert str(error.value) == (
        f"{tmp_path}/x.map.scen: only 8 of 31 tasks are usable, for 9 episodes: line 2: "
        "goal [0, 0]: got the cell of the start; expected another one"
    )


def test_a_missing_file_is_one_line(tmp_path: Path) -> None:
    """The error names the file, the list of tasks as well as the map."""
    maps = family(tmp_path, scen=tmp_path / "y.scen")
    with pytest.raises(MapError) as error:
        maps.sample(RNG, 0, conditions(1, 100))
    assert str(error.value) == f"{tmp_path}/y.scen: no such file or directory; give a file that can be read"
    with pytest.raises(MapError, match=r"y\.scen: no such file or directory; give a file that can be read"):
        maps.words()
    with pytest.raises(MapError, match="is a directory; give a file that can be read"):
        MovingAI(map=tmp_path).tasks(conditions(1, 100), 1)
    (tmp_path / "x.map.scen").unlink()
    with pytest.raises(MapError) as error:
        MovingAI(map=tmp_path / "x.map").words()
    expected = "give a list by `scen`, or one task by `start` and `goal`"
    assert str(error.value) == f"{tmp_path}/x.map.scen: no such file; {expected}"


def test_both_ends_of_a_fixed_task_are_told(tmp_path: Path) -> None:
    """A line for each."""
    family(tmp_path)
    with pytest.raises(MapError) as error:
        MovingAI(map=tmp_path / "x.map", start=(9, 0), goal=(0, 99)).sample(RNG, 0, conditions(1, 100))
    expected = "got a cell outside of the map; expected a row from 0 to 1 and a column from 0 to 29"
    assert str(error.value).splitlines() == [
        f"{tmp_path}/x.map: start [9, 0]: {expected}",
        f"{tmp_path}/x.map: goal [0, 99]: {expected}",
    ]


def test_a_list_that_is_used_up_is_told_as_such(tmp_path: Path) -> None:
    """Where all tasks fit and more are wanted, no task is blamed."""
    maps = family(tmp_path)
    listed = (tmp_path / "x.map.scen").read_text().splitlines()
    (tmp_path / "x.map.scen").write_text("\n".join(listed[i] for i in (0, 3, 4)))
    with pytest.raises(MapError, match=r"x\.map\.scen: 2 tasks for 3 episodes; set `episodes: 2`, or give more tasks$"):
        maps.sample(RNG, 2, conditions(1, 100))


@pytest.mark.parametrize("name", ["x.map", "maps/dao/X.MAP", r"C:\maps\x.map", "x"])
def test_a_list_may_name_its_map_in_any_folder_and_case(tmp_path: Path, name: str) -> None:
    """Such a name is the map's own: nothing is said."""
    maps = family(tmp_path)
    rename(tmp_path, name)
    assert [note for note in maps.notes() if "are played on" in note] == []
    assert maps.tasks(conditions(1, 100), 1) == 1


def rename(folder: Path, name: str) -> None:
    """Let all lines of the list name another map."""
    scen = folder / "x.map.scen"
    scen.write_text(scen.read_text().replace("x.map", name))


def test_a_list_of_another_map_is_refused(tmp_path: Path) -> None:
    """Its lines name another map, and one of its tasks lies on an obstacle of this one."""
    maps = family(tmp_path)
    rename(tmp_path, "b.map")
    with pytest.raises(MapError) as error:
        maps.tasks(conditions(1, 100), 1)
    assert str(error.value) == (
        f"{tmp_path}/x.map.scen:2:1  got 31 tasks of b.map, 1 of them on obstacles of x.map; expected tasks of x.map "
        "(name another list by scen, or this map in the list)."
    )


def test_how_a_list_was_read_is_told(tmp_path: Path) -> None:
    """Tasks on obstacles are counted; those of a map of another name are played, where all fit, and told."""
    maps = family(tmp_path)
    scen = tmp_path / "x.map.scen"
    assert maps.notes() == [f"{scen}: 1 of 31 tasks lie on obstacles and are left out, the first on line 32"]
    (tmp_path / "x.map").write_text(MAP.replace("@", "."))
    rename(tmp_path, "old.map")
    assert maps.notes() == [f"{scen}: 31 tasks of old.map are played on x.map"]
    scen.write_text(scen.read_text().replace("old.map", "x.map"))
    assert maps.notes() == []


def test_a_fixed_task_is_that_of_every_episode(tmp_path: Path) -> None:
    """Start and goal in cells take the place of a list, which need not be there; other tasks have other words."""
    maps = family(tmp_path, start=(1, 2), goal=(0, 7))
    (tmp_path / "x.map.scen").unlink()
    for episode in (0, 999):
        world = maps.sample(RNG, episode, conditions(1, 100))
        assert (world.start, world.task.goal, world.shortest()) == ((1, 2), (0, 7), 6.0)
    assert maps.tasks(conditions(1, 100), 1) is None
    assert [note.partition(": ")[2] for note in maps.notes()] == [ONE_TASK]
    assert maps.words() != maps.model_copy(update={"goal": (0, 8)}).words()


@pytest.mark.parametrize(
    ("start", "goal", "text"),
    [
        ((1, 29), (0, 0), "start [1, 29]: got an obstacle; expected a free cell"),
        ((0, 0), (1, 29), "goal [1, 29]: got an obstacle; expected a free cell"),
        (
            (0, 0),
            (2, 0),
            "goal [2, 0]: got a cell outside of the map; expected a row from 0 to 1 and a column from 0 to 29",
        ),
        ((0, 0), (0, 0), "goal [0, 0]: got the cell of the start; expected another one"),
        (
            (0, 0),
            (0, 3),
            (
                "goal [0, 3]: got a shortest path of 3 cells from the start [0, 0]; expected an optimum of 5 to 12 "
                "cells (set by `tasks: {distance: ...}`)"
            ),
        ),
    ],
)
def test_a_fixed_task_that_cannot_be_is_one_line(tmp_path: Path, start: Cell, goal: Cell, text: str) -> None:
    """The line says which end is wrong, and why."""
    with pytest.raises(MapError) as error:
        family(tmp_path, start=start, goal=goal).sample(RNG, 0, conditions(5, 12))
    assert str(error.value) == f"{tmp_path}/x.map: {text}"


def test_a_fixed_task_that_is_not_connected_is_one_line(tmp_path: Path) -> None:
    """No path is another reason than one that is too long."""
    maps = family(tmp_path, start=(0, 0), goal=(0, 29))
    (tmp_path / "x.map").write_text(
        MAP.replace("." * 29 + "@", "." * 14 + "@" + "." * 15).replace("." * 30, "." * 14 + "T" * 16)
    )
    with pytest.raises(MapError, match=r"goal \[0, 29\]: got an obstacle; expected a free cell$"):
        maps.sample(RNG, 0, conditions(1, 100))
    maps = maps.model_copy(update={"goal": (1, 29)})
    with pytest.raises(MapError, match=r"goal \[1, 29\]: no path leads here from the start \[0, 0\]$"):
        maps.sample(RNG, 0, conditions(1, 100))


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ({"start": (0, 0)}, "start and goal, or neither"),
        ({"goal": (0, 0)}, "start and goal, or neither"),
        ({"start": (0, 0), "goal": (0, 1), "scen": "x.scen"}, "scen, or start and goal; not both"),
    ],
)
def test_half_a_task_is_refused(fields: dict[str, Any], expected: str) -> None:
    """A task has two ends, and takes the place of a list."""
    with pytest.raises(ValidationError, match=expected):
        MovingAI.model_validate({"map": "x.map", **fields})
