"""Robots as a user meets them: checked, run, resumed, replayed; and skipped where a package is missing."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

import fogbench
from fogbench.bench.playing.episode import TIMINGS

SCENARIO = """\
name: hall
about: A robot in small halls.
kind: robot
maps: {blobs: {size: 60, obstacles: [4, 4], obstacle_size: [4, 10]}}
sensor: {beams: 60}
tasks: {distance: [3, 20]}
budget: {steps: 40}
agents: [astar, hfn]
episodes: 3
"""

WITHOUT = """
import sys
sys.modules[sys.argv[1]] = None
sys.argv[1:] = ["check", "hall.yaml"]
from fogbench.bench.command import main
main()
"""
"""Checks where a package is missing."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the scenario."""
    (tmp_path / "hall.yaml").write_text(SCENARIO)
    return tmp_path


def python(folder: Path, *words: str) -> str:
    """What Python prints."""
    environment = {**os.environ, "PYTHONPATH": str(Path(fogbench.__file__).parents[1]), "COLUMNS": "200"}
    command = [sys.executable, *words]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def rows(folder: Path, workers: int) -> pd.DataFrame:
    """All rows of a run with so many workers, in order, without their timings."""
    results = f"results{workers}"
    python(folder, "-m", "fogbench", "run", "hall.yaml", "--results", results, "--workers", str(workers))
    found: pd.DataFrame = pd.read_parquet(folder / results / "hall" / "episodes")
    return found.sort_values(["agent", "episode"]).drop(columns=list(TIMINGS)).reset_index(drop=True)


def test_workers_resuming_and_replays(folder: Path) -> None:
    """One worker or two give the same rows, a second run plays nothing, and an episode ends as it is recorded."""
    one, two = (rows(folder, workers) for workers in (1, 2))
    for column in one:
        assert all(np.array_equal(a, b) for a, b in zip(one[column], two[column], strict=True)), column
    assert set(one["outcome"]) == {"REACHED"}
    assert (one["reference_length"] > 0).all()
    assert all(len(actions) == 3 * steps for actions, steps in zip(one["actions"], one["steps"], strict=True))
    told = python(folder, "-m", "fogbench", "run", "hall.yaml", "--results", "results1")
    assert "6 episodes were recorded before, 0 were played now." in told
    for out in ("hall.png", "hall.gif"):
        words = ("replay", "hall.yaml", "--agent", "astar", "--episode", "1", "--results", "results1", "--out", out)
        assert "It ends as recorded." in python(folder, "-m", "fogbench", *words)
        with Image.open(folder / out) as image:
            assert len(np.unique(np.asarray(image.convert("RGB")).reshape(-1, 3), axis=0)) > 5


def test_without_mujoco_scenarios_are_skipped(folder: Path) -> None:
    """It says which extra brings it."""
    told = python(folder, "-c", WITHOUT, "mujoco")
    assert 'robot needs the extra robot: pip install ".[robot]"' in told


def test_without_navground_its_agent_is_skipped(folder: Path) -> None:
    """The others play."""
    told = python(folder, "-c", WITHOUT, "navground")
    assert 'hfn is skipped: needs the extra robot: pip install ".[robot]"' in told
    assert "3 episodes of 1 agent" in told
