"""Benchmark maps with their tasks."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.movingai import MovingAI
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
    assert maps.tasks(conditions(5, 12)) == 8
    assert sorted(goals(maps, conditions(5, 12), 8)) == [(0, column) for column in range(5, 13)]
    assert maps.tasks(conditions(1, 100)) == 29
    assert maps.tasks(conditions(50, 100)) == 0


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
    assert there.tasks(conditions(1, 100)) == 0


def test_an_episode_past_the_last_task_is_one_line(tmp_path: Path) -> None:
    """The error says the episode and how many there are."""
    with pytest.raises(MapError) as error:
        family(tmp_path).sample(RNG, 8, conditions(5, 12))
    assert str(error.value) == (
        f"{tmp_path}/x.map.scen: got episode 8, counted from 0; "
        "expected at most 8 episodes, the tasks with an optimum of 5 to 12 cells"
    )


def test_a_missing_file_is_one_line(tmp_path: Path) -> None:
    """The error names the file, the list of tasks as well as the map."""
    maps = family(tmp_path, scen=tmp_path / "y.scen")
    with pytest.raises(MapError) as error:
        maps.sample(RNG, 0, conditions(1, 100))
    assert str(error.value) == f"{tmp_path}/y.scen: got no such file or directory; expected a file to read"
    with pytest.raises(MapError, match=r"y\.scen: got no such file or directory; expected a file to read"):
        maps.words()
    with pytest.raises(MapError, match="got is a directory; expected a file to read"):
        MovingAI(map=tmp_path).tasks(conditions(1, 100))
