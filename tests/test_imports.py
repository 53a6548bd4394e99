"""What an import brings with it: the face and the tables name everything and load nothing."""

import ast
import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from pkgutil import resolve_name

import pytest

import fogbench
from fogbench import learned, planners
from fogbench.bench.shipped import folder
from fogbench.learned import LEARNED
from fogbench.planners import JUDGES, PLANNERS
from fogbench.worlds import FAMILIES, KINDS

HEAVY = {"torch", "ompl", "mujoco", "numba", "matplotlib", "sklearn"}

STUB = ast.parse(Path(fogbench.__file__).with_suffix(".pyi").read_text("utf-8"))

FACE = {
    name.name: f"fogbench.{line.module}"
    for line in ast.walk(STUB)
    if isinstance(line, ast.ImportFrom)
    for name in line.names
}
"""The names of the face, and the modules that they come from."""

TARGETS = {**PLANNERS, **LEARNED, **FAMILIES, **{name: kind.conditions for name, kind in KINDS.items()}, **JUDGES}


NETS = """
name: nets
maps: {blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}}
budget: {steps: 30}
agents: [astar, macn: {checkpoint: macn-grid}]
episodes: 2
"""


def loaded(code: str) -> set[str]:
    """The modules that are loaded after some code has run in a process of its own."""
    report = f"{code}\nimport sys\nprint('\\nLOADED', *sys.modules)"
    environment = {**os.environ, "PYTHONPATH": str(Path(fogbench.__file__).parents[1])}
    text = subprocess.check_output([sys.executable, "-c", report], env=environment, text=True)
    return set(text.rpartition("LOADED")[2].split())


def told(*arguments: str) -> str:
    """Code that runs the command line to its end."""
    return (
        f"import sys; sys.argv = {['fogbench', *arguments]}\n"
        "from fogbench.bench.command import main\n"
        "try:\n    main()\n"
        "except SystemExit as end:\n    assert not end.code, end.code"
    )


def test_heavy_packages_would_be_noticed() -> None:
    """A module that needs Numba shows up in what is loaded."""
    assert "numba" in loaded("import fogbench.worlds.kernel")


@pytest.mark.parametrize(
    "code",
    [
        "import fogbench.bench.command",
        told("--help"),
        told("list"),
        told("run", "--help"),
        told("train", "--help"),
        told("look", "--help"),
    ],
    ids=["import", "--help", "list", "run --help", "train --help", "look --help"],
)
def test_the_command_line_loads_nothing_heavy(code: str) -> None:
    """Help and lists come at once: no torch, OMPL, MuJoCo, Numba, matplotlib or scikit-learn."""
    assert not HEAVY & loaded(code)


def test_the_face_alone_loads_nothing() -> None:
    """Neither a module of the project, nor any package but the one that waits to be asked."""
    new = loaded("import fogbench") - loaded("import ast, lazy_loader, pathlib")
    assert new == {"fogbench"}


def test_the_face_loads_what_is_asked_for_alone() -> None:
    """The words of a planner need no network, and those of settings no Numba."""
    assert not HEAVY & loaded("from fogbench import Settings, Task, Observation, Move, BLOCKED, Mistake")
    assert not HEAVY - {"numba"} & loaded("from fogbench import KnownMap, Route, search, SquareMaps, Layout")


@pytest.mark.parametrize("name", FACE)
def test_a_name_of_the_face_is_that_of_its_module(name: str) -> None:
    """The same object, whoever is asked first."""
    assert getattr(fogbench, name) is getattr(import_module(FACE[name]), name)


def test_the_face_is_what_its_stub_says() -> None:
    """No name more, and none less."""
    assert set(fogbench.__all__) == set(FACE)
    with pytest.raises(AttributeError):
        fogbench.nothing  # noqa: B018  it is asked for


def test_a_check_loads_no_tables_and_no_plots() -> None:
    """It draws a world of each variant, for which it needs Numba, and holds all weights against their settings."""
    found = loaded(told("check", "grid"))
    assert {"numba", "safetensors", "fogbench.planners.rrt_star", "fogbench.learned.macn"} <= found
    light = {"pandas", "pyarrow", "matplotlib", "scipy.stats", "scipy.sparse", "sklearn", "torch"}
    assert not light & found


def test_a_report_and_a_replay_load_no_network(tmp_path: Path) -> None:
    """What a network did is told and drawn again from its record alone."""
    (tmp_path / "nets.yaml").write_text(NETS)
    place, results = str(tmp_path / "nets.yaml"), str(tmp_path / "results")
    assert "torch" not in loaded(told("run", place, "--results", results))  # its workers have it
    assert "torch" not in loaded(told("report", place, "--results", results))
    out = str(tmp_path / "replay.png")
    assert "torch" not in loaded(told("replay", place, "--agent", "macn", "--results", results, "--out", out))
    assert Path(out).exists()


def test_reading_a_scenario_loads_no_torch() -> None:
    """Settings of all networks are read, and their weights held against them, before anything can play."""
    code = (
        "from pathlib import Path\n"
        "from fogbench.bench.reading.scenario import read_scenario, text_of\n"
        f"place = Path({str(folder() / 'paper' / 'grid.yaml')!r})\n"
        "agents = read_scenario(text_of(place), place).variants[0].agents\n"
        "assert {'macn', 'vin'} <= {agent.target.rpartition('.')[2].partition(':')[0] for agent in agents}\n"
        "assert all(agent.settings for agent in agents)"
    )
    assert "torch" not in loaded(code)


def test_tables_load_none_of_their_entries() -> None:
    """Importing the packages with the tables imports no module that the tables name."""
    modules = {target.partition(":")[0] for target in TARGETS.values()}
    assert not modules & loaded("import fogbench.worlds, fogbench.planners, fogbench.learned")


@pytest.mark.parametrize("target", TARGETS.values(), ids=TARGETS)
def test_every_target_is_a_class(target: str) -> None:
    """Each entry of each table leads to a class, in the file that it names."""
    found = resolve_name(target)
    assert isinstance(found, type)
    assert f"{found.__module__}:{found.__name__}" == target


def test_extras_belong_to_agents() -> None:
    """An extra is named for a planner or a policy that there is."""
    assert set(planners.EXTRAS) <= set(PLANNERS)
    assert set(learned.EXTRAS) <= set(LEARNED)
