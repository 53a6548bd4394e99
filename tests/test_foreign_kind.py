"""A kind of world from a package of its own: it is checked, run, judged, reported, replayed and listed like any other.

The package is `tests/plugin/ring_kind`: rings of numbered stations. Nothing of the harness knows it.
"""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from PIL import Image

import fogbench

PLUGINS = Path(__file__).parent / "plugin"

RECIPE = """\
name: round
network: ring_net
maps: {stations: {size: 9, cut: 0.5}}
track: {slip: 0.1}
budget: {steps: 20}
learning: {imitation: {batches: 30, batch: 32, rate: [1e-1, 1e-2], curriculum: {easy: {size: 5}}}}
validation: {episodes: 40, every: 10}
"""

NETS = """\
name: nets
maps: {stations: {size: 9, cut: 0.5}}
budget: {steps: 20}
agents:
  - walker
  - ring_net: {checkpoint: none, label: fresh}
  - ring_net: {checkpoint: results/training/round/round.safetensors, label: trained}
episodes: 40
"""

MIXED = """\
name: mixed
about: Rings and grids.
budget: {steps: {per_distance: 3, plus: 6}}
variants:
  ring: {maps: {stations: {size: 9, cut: 0.5}}, track: {slip: 0.2}}
  grid: {maps: {blobs: {size: 8, obstacles: [0, 4], obstacle_size: [1, 2]}}, sensor: {radius: 2}, reference: astar}
  walls: {kind: ring, maps: {blobs: {size: 4, obstacles: [0, 3], obstacle_size: [1, 1]}}}
agents: [walker, astar]
episodes: 6
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder where the package is installed, with its entry points."""
    place = tmp_path_factory.mktemp("site")
    for name in ("ring_kind", "ring_kind-1.0.dist-info"):
        shutil.copytree(PLUGINS / name, place / name, ignore=shutil.ignore_patterns("__pycache__"))
    return place


@pytest.fixture(scope="module")
def command(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[..., tuple[int, str]]:
    """Runs fogbench in a folder with the scenario, and the package on the path."""
    folder = tmp_path_factory.mktemp("here")
    (folder / "mixed.yaml").write_text(MIXED)
    place = os.pathsep.join([str(site), str(Path(fogbench.__file__).parents[1])])

    def command(*words: str, **texts: str) -> tuple[int, str]:
        for name, text in texts.items():
            (folder / f"{name}.yaml").write_text(text)
        environment = {**os.environ, "PYTHONPATH": place, "COLUMNS": "200"}
        line = [sys.executable, "-m", "fogbench", *words]
        done = subprocess.run(line, cwd=folder, env=environment, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    command.folder = folder  # type: ignore[attr-defined]
    return command


@pytest.fixture(scope="module")
def played(command: Any) -> pd.DataFrame:
    """The rows of a run of the scenario."""
    code, text = command("run", "mixed.yaml")
    assert code == 0, text
    rows: pd.DataFrame = pd.read_parquet(command.folder / "results" / "mixed" / "episodes")
    return rows


def test_a_scenario_that_mixes_kinds_is_checked(command: Any) -> None:
    """Each variant has the blocks of its kind, and says who cannot play there."""
    code, text = command("check", "mixed.yaml")
    assert code == 0, text
    assert text.count("6 episodes of 1 agent") == 3
    assert "astar is skipped: it plays graph, grid, robot worlds, not ring" in text
    assert "walker is skipped: it plays ring worlds, not grid" in text


def test_episodes_are_referenced_and_judged(played: pd.DataFrame) -> None:
    """The walker is its own reference, is never wrong, and knows at each step how far the goal still is."""
    rings = played[played["agent"] == "walker"]
    assert set(rings["kind"]) == {"ring"}
    assert (rings["outcome"] == "REACHED").any()
    reached = rings[rings["outcome"] == "REACHED"]
    assert (reached["reference_length"] == reached["length"]).all()
    assert rings["judged"].sum() > 30
    assert (rings["wrong_decisions"] + rings["strict_wrong"]).sum() == 0
    for row in rings.to_dict("records"):
        assert len(row["remaining"]) == len(row["decision_seconds"])
        assert row["remaining"][0] == row["shortest"]


def test_covariates_are_those_of_the_kind(played: pd.DataFrame) -> None:
    """Rings have stations, grids have a density; the others' columns are empty."""
    rings, grids = (played[played["kind"] == kind] for kind in ("ring", "grid"))
    assert set(rings["stations"]) == {9.0, 16.0}
    assert rings["density"].isna().all()
    assert grids["stations"].isna().all()
    assert grids["density"].notna().all()


def test_a_map_of_cells_serves_another_kind(played: pd.DataFrame) -> None:
    """Blobs make rings of 16 stations, since the kind says so."""
    walls = played[played["variant"] == "walls"]
    assert (set(walls["kind"]), set(walls["stations"])) == ({"ring"}, {16.0})


@pytest.mark.usefixtures("played")
def test_nothing_is_played_twice(command: Any) -> None:
    """A second run finds all its episodes."""
    code, text = command("run", "mixed.yaml")
    assert code == 0
    assert "18 episodes were recorded before, 0 were played now." in text


@pytest.mark.usefixtures("played")
def test_a_report_speaks_of_the_kind(command: Any) -> None:
    """Its reference has its own name."""
    code, text = command("report", "mixed.yaml")
    assert code == 0, text
    page = (command.folder / "results" / "mixed" / "summary.md").read_text()
    assert "ratio to the shorter way or A*" in page


@pytest.mark.usefixtures("played")
@pytest.mark.parametrize("suffix", ["png", "gif"])
@pytest.mark.parametrize(("variant", "agent"), [("ring", "walker"), ("walls", "walker"), ("grid", "astar")])
def test_episodes_replay_and_are_drawn(variant: str, agent: str, suffix: str, command: Any) -> None:
    """Recorded numbers lead to the recorded end, and its layers become a picture."""
    out = f"{variant}.{suffix}"
    code, text = command("replay", "mixed.yaml", "--agent", agent, "--variant", variant, "--episode", "1", "--out", out)
    assert code == 0, text
    assert "It ends as recorded." in text
    with Image.open(command.folder / out) as image:
        assert len(np.unique(np.asarray(image.convert("RGB")).reshape(-1, 3), axis=0)) > 4


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("track", "trak", "variants.ring: got trak; expected one of maps, kind, track, tasks, budget, sensor, rules"),
        ("track: {slip: 0.2}", "sensor: {radius: 1}", "variants.ring: got sensor; expected one of"),
        (
            "kind: ring",
            "kind: rink",
            "variants.walls.kind: got rink; expected one of grid, graph, robot, ring. Did you mean ring?",
        ),
        ("sensor: {radius", "kind: ring, sensor: {radius", "variants.grid: got sensor; expected one of"),
        (
            "{maps: {stations: {size: 9, cut: 0.5}}, track: {slip: 0.2}}",
            "{kind: grid, maps: {stations: {size: 9}}}",
            "variants.ring.kind: got grid; expected a kind that these maps can be: ring.",
        ),
    ],
)
def test_a_mistake_names_the_blocks_of_the_kind(old: str, new: str, expected: str, command: Any) -> None:
    """One line at its place, with the nearest valid name."""
    assert old in MIXED
    code, text = command("check", "wrong.yaml", wrong=MIXED.replace(old, new, 1))
    assert code == 2
    assert expected in text
    assert "Traceback" not in text


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        ("judge.py", "right.any():", "right.all(0)[9]:", ": the judge raised IndexError: "),
        ("judge.py", "class RingJudge", "class Judge", "fogbench.judges: ring: got ring_kind.judge:RingJudge, which "),
        ("stations.py", '("ring",)', '"ring"', "a map family whose kinds are a tuple of names; this one has 'ring'"),
        ("conditions.py", "budget: BudgetSettings", "limit: int = 9", "whose conditions have a budget; those of ring "),
        ("conditions.py", '("stations",)', '("steps",)', "covariates: got steps; expected names that no column has."),
        ("conditions.py", '("stations",)', "()", "covariates: got stations; expected none"),
        ("world.py", "def remaining", "def rest", ": the world, asked what remains to the goal"),
    ],
)
def test_a_mistake_in_the_package_is_blamed_on_it(
    file: str, old: str, new: str, expected: str, command: Any, site: Path
) -> None:
    """One line that names it; no agent is said to have crashed, and there is no traceback."""
    source = site / "ring_kind" / file
    text = source.read_text()
    assert old in text
    source.write_text(text.replace(old, new))
    try:
        code, told = command("run", "faulty.yaml", faulty=MIXED.replace("name: mixed", "name: faulty"))
    finally:
        source.write_text(text)
    assert code in {1, 2}
    assert expected in told
    assert "Traceback" not in told
    assert "CRASHED" not in told


def test_the_schema_and_the_list_have_it(command: Any) -> None:
    """Its block, its name, its family and its agent."""
    code, text = command("schema")
    schema = json.loads(text)
    assert code == 0
    assert schema["properties"]["kind"]["anyOf"][0]["enum"] == ["grid", "graph", "robot", "ring"]
    assert {"track", "sensor"} <= schema["properties"].keys()
    _, text = command("list")
    assert "stations" in text
    assert "walker" in text


def test_a_kind_that_lacks_a_package_is_skipped(command: Any, site: Path) -> None:
    """Its variants say which, the others are played; a scenario of nothing else is skipped as a whole."""
    world = site / "ring_kind" / "world.py"
    text = world.read_text()
    world.write_text("import fog_lamp\n" + text)
    try:
        code, told = command("check", "mixed.yaml")
        assert code == 0, told
        assert "ring is skipped: " in told
        assert "needs the package fog_lamp, which is not installed" in told
        assert "grid: 6 episodes of 1 agent" in told
    finally:
        world.write_text(text)


def test_a_network_of_its_own_learns_by_imitation(command: Any) -> None:
    """From a recipe of its kind, in a few batches; in a scenario it then does better than before, and is replayed."""
    code, text = command("train", "round.yaml", round=RECIPE)
    assert code == 0, text
    assert "The best weights" in text
    code, text = command("run", "nets.yaml", nets=NETS)
    assert code == 0, text
    rows = pd.read_parquet(command.folder / "results" / "nets" / "episodes")
    success = (rows["outcome"] == "REACHED").groupby(rows["agent"]).mean()
    assert success["trained"] > 0.9 > success["fresh"]
    assert rows.loc[rows["agent"] == "trained", "judged"].sum() > 40
    code, text = command("replay", "nets.yaml", "--agent", "trained", "--out", "net.png")
    assert code == 0, text
    assert "It ends as recorded." in text
    code, text = command("look", "nets.yaml", "--agent", "trained")
    assert code == 0, text
    assert "scores of the moves" in text


def test_a_network_of_another_kind_does_not_learn_there(command: Any) -> None:
    """One line says which worlds it plays."""
    code, text = command("train", "wrong_net.yaml", wrong_net=RECIPE.replace("network: ring_net", "network: vin"))
    assert code == 2
    assert "network: got one that plays grid; expected one that plays worlds of kind ring." in text
