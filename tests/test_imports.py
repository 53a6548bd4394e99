"""What an import brings with it: the tables name everything and load nothing."""

import os
import subprocess
import sys
from pathlib import Path
from pkgutil import resolve_name

import pytest

import fogbench
from fogbench import learned, planners
from fogbench.bench.shipped import folder
from fogbench.learned import LEARNED
from fogbench.planners import PLANNERS
from fogbench.worlds import FAMILIES, KINDS

HEAVY = {"torch", "ompl", "mujoco", "numba", "matplotlib", "sklearn"}

TARGETS = {**PLANNERS, **LEARNED, **FAMILIES, **KINDS}


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
    assert not modules & loaded("import fogbench.worlds, planners, learned")


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
