"""From a recorded row to a picture: what is told, and what is refused."""

import json
from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from fogbench.bench.drawing import key, known, truth
from fogbench.bench.film import film
from fogbench.bench.playback import replay_recorded
from fogbench.bench.playing.keys import agent_key, world_key
from fogbench.bench.playing.play import lost, play
from fogbench.bench.playing.provenance import noted, read_run
from fogbench.bench.playing.recorder import recording
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.picture import Cells, Dots, Lines, Picture, Squares
from fogbench.worlds.types import Outcome

Make = Callable[..., Scenario]


@pytest.fixture
def played(make: Make, tmp_path: Path) -> Scenario:
    """Recorded in `tmp_path/store`: of A* an episode, one that hung, and one of other sources."""
    scenario = make()
    variant = scenario.variants[0]
    astar = variant.agents[0]
    with recording(tmp_path / "store", ()) as recorder:
        recorder.append(play(scenario, variant, astar, 0, 1))
        recorder.append(lost(scenario, variant, astar, 1, 1, Outcome.HUNG, "no [answer]"))
        recorder.append(replace(play(scenario, variant, astar, 2, 1), agent_key="old"))
    return scenario


def test_a_replay_says_what_was_verified(played: Scenario, tmp_path: Path) -> None:
    """An episode ends as recorded; of one that hung nothing is known; the case of the ending does not matter."""
    for episode, checked in enumerate(("It ends as recorded", "Nothing was recorded to verify")):
        for name in ("a.PNG", "b.gif"):
            out = tmp_path / f"{episode}{name}"
            told = replay_recorded(played, None, "astar", episode, tmp_path / "store", out)
            assert told.splitlines()[1] == f"{checked}. Drawn in {out}"
            assert out.stat().st_size > 0


@pytest.mark.parametrize("name", ["nodir/x.png", "folder.png", "x.jpg"])
def test_a_place_that_cannot_be_drawn_into_is_refused_first(name: str, played: Scenario, tmp_path: Path) -> None:
    """Even an agent that is not there comes after it; the line says what would do."""
    (tmp_path / "folder.png").mkdir()
    out = tmp_path / name
    with pytest.raises(Mistake) as caught:
        replay_recorded(played, None, "nobody", 0, tmp_path / "store", out)
    wanted = "name that ends in .png or .gif" if name == "x.jpg" else "file in a folder that can be written"
    assert str(caught.value) == f"--out: got {out}; expected a {wanted}."


def test_an_episode_of_another_machine_is_replayed(make: Make, tmp_path: Path) -> None:
    """It stays current under the versions that `run.json` tells; the last line says which differ."""
    scenario, store = make(), tmp_path / "store"
    variant = scenario.variants[0]
    with recording(store, ()) as recorder, noted(store, scenario, 1):
        run = read_run(store)
        there = run["sessions"][0]["versions"]
        there["numpy"] = "1"
        keys = {"agent_key": agent_key(variant.agents[0], there), "world_key": world_key(variant, there)}
        recorder.append(replace(play(scenario, variant, variant.agents[0], 0, 1), **keys))
    (store / "run.json").write_text(json.dumps(run))
    told = replay_recorded(scenario, None, "astar", 0, store, tmp_path / "x.png").splitlines()
    assert told[1].startswith("It ends as recorded")
    assert told[2:] == [f"Recorded with numpy 1; here is numpy {version('numpy')}."]


def test_an_episode_of_other_sources_is_told(played: Scenario, tmp_path: Path) -> None:
    """It is not there any more, and the line says why."""
    with pytest.raises(Mistake) as caught:
        replay_recorded(played, None, "astar", 2, tmp_path / "store", tmp_path / "x.png")
    assert str(caught.value) == (
        "--episode: got 2; expected one of the 2 of astar in variant short, from 0 to 1. 1 recorded episodes of "
        "astar in variant short do not count any more: its settings, files, sources or packages have changed; "
        "`fogbench run` plays them again."
    )


def test_a_key_names_what_is_drawn() -> None:
    """Of cells their readings, of lines the map; and each layer over them by its name, in its colour."""
    dot, cells = Dots(np.zeros((1, 2))), Cells(np.zeros((2, 2), np.uint8))
    lines = Lines(np.zeros((1, 2, 2)))
    grid = Picture((2, 2), (cells,), (cells,), Squares(np.zeros((1, 2), int)), *[Squares(np.zeros((1, 2), int))] * 3)
    graph = Picture((2, 2), (lines,), (lines,), lines, lines, dot, dot)
    assert list(key(grid)) == ["unknown", "free", "blocked", "view", "path", "agent", "goal"]
    assert list(key(graph)) == ["map", "view", "path", "agent", "goal"]
    for picture in (grid, graph):
        colours = {
            tuple(pixel) for pixel in (*truth(picture).reshape(-1, 3).tolist(), *known(picture).reshape(-1, 3).tolist())
        }
        assert key(picture)["agent"] in colours


@pytest.mark.parametrize("wide", [3, 40])
def test_a_film_has_its_key_below(wide: int, tmp_path: Path) -> None:
    """Every colour of it is in the picture, however narrow the world is."""
    map_ = np.full((40, wide, 3), 255, np.uint8)
    names = {"path": (0, 114, 178), "agent": (213, 94, 0), "goal": (0, 158, 115)}
    film([(map_, map_, 0), (map_, map_, 1)], names, tmp_path / "a.gif")
    with Image.open(tmp_path / "a.gif") as picture:
        assert picture.height > 360
        below = np.asarray(picture.convert("RGB"))[360:].reshape(-1, 3).astype(int)
    for colour in names.values():
        assert np.abs(below - colour).sum(1).min() < 30
