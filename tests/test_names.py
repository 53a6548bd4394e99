"""One importable name: whoever else has packages called worlds, planners, learned or bench keeps them."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import fogbench

NAMES = ("worlds", "planners", "learned", "bench")

PLUGIN = Path(__file__).with_name("plugin")

SCENARIO = """
name: mine
about: Of another package.
maps: {"my_package.salt:Salt": {size: 7, share: 0.1}}
sensor: {radius: 2}
budget: {steps: 12}
agents: [astar, "my_package.compass:Compass", {vin: {checkpoint: none, size: [5, 5], iterations: 2}}]
episodes: 6
"""

RECIPE = """
name: small
network: {vin: {size: [5, 5], iterations: 2}}
maps: {"my_package.salt:Salt": {size: 7, share: 0.1}}
budget: {steps: 8}
learning: {imitation: {batches: 1, batch: 2}}
validation: {episodes: 2, every: 1}
"""

COMMANDS = {
    "--help": "",
    "list": "astar",
    "schema": '"agents"',
    "check mine.yaml": "mine",
    "run mine.yaml --workers 1": "18 were played now",
    "report mine.yaml": "Compass",
    "replay mine.yaml --agent Compass": "replay.png",
    "look mine.yaml --agent vin": "tsne-all-vin.png",
    "train small.yaml": "small.safetensors",
}
"""What each command prints a part of."""

ALL = """
import contextlib, io, json, sys
from importlib import import_module
from pkgutil import walk_packages
import fogbench
from fogbench.bench.command import main

told = {}
for command in sys.argv[1:]:
    sys.argv = ["fogbench", *command.split()]
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        try:
            main()
        except SystemExit as end:
            told[command] = (end.code or 0, out.getvalue())
modules = []
for name in ("worlds", "planners", "learned", "bench"):
    package = import_module(f"fogbench.{name}")
    modules += [module.name for module in walk_packages(package.__path__, f"{package.__name__}.")]
told["modules"] = (0, " ".join(import_module(name).__name__ for name in modules))
print(json.dumps(told))
"""
"""Does what each argument says, one after the other, then imports all modules; prints what became of it."""


def python(folder: Path, code: str, *arguments: str) -> str:
    """What some code prints, in a folder whose packages come before all others."""
    place = Path(fogbench.__file__).parents[1]
    paths = os.pathsep.join(map(str, (folder, PLUGIN, place)))
    environment = {**os.environ, "PYTHONPATH": paths, "COLUMNS": "200"}
    command = [sys.executable, "-c", code, *arguments]
    run = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return run.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a scenario, a recipe, and four packages of somebody else that cannot be imported."""
    folder = tmp_path_factory.mktemp("mine")
    for name in NAMES:
        (folder / name).mkdir()
        (folder / name / "__init__.py").write_text(f"raise RuntimeError('the {name} of somebody else')\n")
    (folder / "mine.yaml").write_text(SCENARIO)
    (folder / "small.yaml").write_text(RECIPE)
    return folder


@pytest.fixture(scope="module")
def told(folder: Path) -> dict[str, tuple[int, str]]:
    """How each command ends there, and what it says."""
    said: dict[str, tuple[int, str]] = json.loads(python(folder, ALL, *COMMANDS).splitlines()[-1])
    return said


@pytest.mark.parametrize("name", NAMES)
def test_those_of_somebody_else_come_first(name: str, folder: Path) -> None:
    """Whoever imported one of them by mistake would notice."""
    with pytest.raises(AssertionError, match=f"RuntimeError: the {name} of somebody else"):
        python(folder, f"import {name}")


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_works_beside_them(command: str, told: dict[str, tuple[int, str]]) -> None:
    """With a planner and a map family of another package."""
    code, text = told[command]
    assert code == 0, text
    assert COMMANDS[command] in text


def test_every_module_can_be_imported_beside_them(told: dict[str, tuple[int, str]]) -> None:
    """Those too that no command has asked for."""
    assert {"fogbench.worlds.types", "fogbench.learned.dnc.dnc", "fogbench.bench.doctor"} <= set(
        told["modules"][1].split()
    )


def test_the_module_is_the_command(folder: Path) -> None:
    """`python -m fogbench` does the same."""
    help_ = "import runpy, sys; sys.argv[1:] = ['--help']; runpy.run_module('fogbench', run_name='__main__')"
    assert "fogbench" in python(folder, help_)
