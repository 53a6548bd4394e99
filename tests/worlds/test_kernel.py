"""Kernels run wherever Python runs, kept on disk where that is possible."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import worlds

SCRIPT = """
import numpy as np
from worlds.belief import __file__, look
from worlds.distances import distances
print(__file__)
print(look.stats.cache_path)
print(look(np.eye(3, dtype=np.bool_), 0, 1, 1, True).tolist())
print(distances(np.eye(3, dtype=np.bool_), (0, 1), (-1, -1))[1, 2])
"""


def run(folder: Path) -> list[str]:
    """Run the script on a copy of `worlds`, in an environment whose home is a file that can hold nothing."""
    home = folder / "home"
    home.touch()
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("NUMBA_", "XDG_", "PYTHON"))}
    environment = {**kept, "HOME": str(home), "PYTHONPATH": str(folder)}
    command = [sys.executable, "-c", SCRIPT]
    return subprocess.check_output(command, env=environment, cwd=folder, text=True).splitlines()


def copy(folder: Path) -> Path:
    """Copy the sources of `worlds`, and nothing that was compiled from them."""
    source = Path(worlds.__file__).parent
    return shutil.copytree(source, folder / "worlds", ignore=shutil.ignore_patterns("__pycache__"))


RESULT = ["[[0, 2, 2], [2, 1, 1], [0, 2, 1]]", "2"]


def test_kernels_are_kept_beside_their_source(tmp_path: Path) -> None:
    """Where that can be written, the compiled form is on disk after the first call."""
    package = copy(tmp_path)
    file, cache, *result = run(tmp_path)
    assert file == str(package / "belief.py")
    assert Path(cache).is_relative_to(package / "__pycache__")
    assert result == RESULT
    assert list(Path(cache).glob("belief.look-*.nbc"))


def test_an_edit_of_another_file_is_noticed(tmp_path: Path) -> None:
    """A constant that a kernel takes from elsewhere is compiled into it, and compiled anew when it changes."""
    package = copy(tmp_path)
    before = run(tmp_path)
    types = package / "types.py"
    types.write_text(types.read_text().replace("UNKNOWN, FREE, BLOCKED = 0, 1, 2", "UNKNOWN, FREE, BLOCKED = 0, 1, 3"))
    after = run(tmp_path)
    assert before[1] != after[1]
    assert after[2] == RESULT[0].replace("2", "3")


def test_kernels_run_where_nothing_can_be_written(tmp_path: Path) -> None:
    """Without any place for the cache, a kernel is compiled in its process, and gives the same.

    A file stands where the cache's folder would have to be, and another where the home would be: not even root can
    make a folder there.
    """
    package = copy(tmp_path)
    (package / "__pycache__").touch()
    file, cache, *result = run(tmp_path)
    assert (file, cache) == (str(package / "belief.py"), "None")
    assert result == RESULT
    assert (package / "__pycache__").is_file()
