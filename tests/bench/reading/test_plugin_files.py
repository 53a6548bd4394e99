"""Files as modules: any name, any process."""

import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor
from importlib import import_module
from pathlib import Path

import pytest

from fogbench.bench.playing.keys import agent_key
from fogbench.bench.reading.plugin_files import is_file, module_name
from fogbench.bench.reading.scenario import read_scenario

NAMES = ("bold.v2.py", "my planner.py", "größe.py", "100%.py", "a%2Eb.py", "it's.py", "class.py", "..py", "fogbench.py")

SCENARIO = """
name: mine
maps: {blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}}
budget: {steps: 40}
agents: ["./NAME:Mine"]
episodes: 1
"""

FILE = """
from typing import ClassVar
from fogbench.worlds.settings import Settings

def square(x):
    return x * x

class Mine(Settings):
    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    def start(self, task, rng):
        return None

    def parameter_bytes(self):
        return 0
"""


@pytest.mark.parametrize("name", NAMES)
def test_a_file_of_any_name_is_read_and_has_a_key(name: str, tmp_path: Path) -> None:
    """The key is that of the same contents under a plain name."""
    keys = []
    for place in (tmp_path / name, tmp_path / "other" / "plain.py"):
        place.parent.mkdir(exist_ok=True)
        place.write_text(FILE)
        scenario = read_scenario(SCENARIO.replace("NAME", place.name), place.parent / "mine.yaml")
        (agent,) = scenario.variants[0].agents
        assert agent.label == "Mine"
        assert sys.modules[type(agent.settings).__module__].__file__ == str(place)
        keys.append(agent_key(agent))
    assert keys[0] == keys[1]


def test_names_of_modules_are_files() -> None:
    """No two places have one, and none has a dot of its own."""
    places = [Path("/a", name) for name in NAMES] + [
        Path("/b/bold.v2.py"),
        Path("/a/bold/v2.py"),
        Path("/a/bold_v2.py"),
    ]
    names = {module_name(place) for place in places}
    assert len(names) == len(places)
    assert all(is_file(name) and name.rpartition(".")[0] == "fogbench.bench.reading.plugin_files" for name in names)
    assert not is_file("fogbench.bench.reading.plugin_files")


@pytest.mark.parametrize("how", ["fork", "forkserver", "spawn"])
def test_another_process_finds_its_functions(how: str, tmp_path: Path) -> None:
    """They are handed over by name alone."""
    (tmp_path / "my.squares.py").write_text(FILE)
    square = import_module(module_name(tmp_path / "my.squares.py")).square
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context(how)) as pool:
        assert list(pool.map(square, range(4))) == [0, 1, 4, 9]


def test_a_file_has_no_neighbours(tmp_path: Path) -> None:
    """A relative import is refused, as in any file that is no package's."""
    (tmp_path / "near.py").write_text("from . import other\n")
    with pytest.raises(ImportError, match="no known parent package"):
        import_module(module_name(tmp_path / "near.py"))
    assert module_name(tmp_path / "near.py") not in sys.modules
