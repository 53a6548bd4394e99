"""Kernels run wherever Python runs, kept on disk where that is possible."""

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba.core.codegen import get_host_cpu_features

import fogbench
from fogbench import worlds
from fogbench.worlds import kernel
from fogbench.worlds.types import Array

WITHOUT_RIGHTS = """
import ctypes, os, struct

READ, GROUP, USER, NOBODY = 1 << 2, 1 << 6, 1 << 7, 65534  # CAP_DAC_READ_SEARCH, CAP_SETGID, CAP_SETUID
linux = ctypes.CDLL(None)

def keep(rights):
    header, sets = struct.pack("Ii", 0x20080522, 0), struct.pack("6I", rights, rights, 0, 0, 0, 0)
    return linux.capset(header, sets) == 0

if keep(READ | GROUP | USER):
    linux.prctl(8, 1, 0, 0, 0)  # PR_SET_KEEPCAPS
    os.setgroups([])
    os.setresgid(NOBODY, NOBODY, NOBODY)
    os.setresuid(NOBODY, NOBODY, NOBODY)
    assert keep(READ)
else:
    assert keep(0)
"""
"""Turns its process into one of a user without rights.

Root becomes nobody. It keeps the right to read, since the interpreter may lie in somebody's private folder, but can
write only what is nobody's or everybody's. Where root itself lacks that right (in many containers) it stays who it is
and gives up the power to overrule permissions; so does any other user, who has none: both are then held back by folders
that are read-only for their owner.
"""

FULL_DISK = """
import resource
resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
"""
"""Lets no file of the process, wherever it is, hold a single byte."""

SCRIPT = """
import json
import numpy as np
from fogbench.worlds.maps.cells import __file__, passable
from fogbench.worlds.maps.sight import hidden, look
from fogbench.worlds.kernel import used

assert used() is None
view = look(np.eye(3, dtype=np.bool_), 0, 1, 1, True)
stats = [kernel.stats for kernel in (look, hidden, passable)]
print(json.dumps({
    "file": __file__,
    "folder": used() and str(used()),
    "view": view.tolist(),
    "compiled": sum(sum(each.cache_misses.values()) for each in stats),
    "read": sum(sum(each.cache_hits.values()) for each in stats),
}))
"""

VIEW = [[0, 2, 2], [2, 1, 1], [0, 2, 1]]
COLD = {"view": VIEW, "compiled": 3, "read": 0}
WARM = {"view": VIEW, "compiled": 0, "read": 1}
"""A form that is read has its callees in it."""


def start(folder: Path, script: str = SCRIPT, **environment: str) -> subprocess.Popen[str]:
    """Start a script on the packages in a folder, without a home; any warning is an error."""
    dropped = ("NUMBA_", "XDG_", "PYTHON", "HOME", "TMP", "TEMP")
    kept = {name: value for name, value in os.environ.items() if not name.startswith(dropped)}
    return subprocess.Popen(
        [sys.executable, "-W", "error", "-c", script],
        env={**kept, "PYTHONPATH": str(folder), **environment},
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def end(process: subprocess.Popen[str]) -> dict[str, Any]:
    """What the script has told, on one line and with no other noise."""
    out, err = process.communicate()
    assert (process.returncode, err) == (0, "")
    told: dict[str, Any] = json.loads(out)
    return told


def told(result: dict[str, Any]) -> dict[str, Any]:
    """The part that is the same wherever the packages and the kernels are."""
    return {name: result[name] for name in COLD}


def forms(folder: Path) -> set[str]:
    """The files of compiled kernels below a folder."""
    return {path.name.partition("-")[0] for path in folder.rglob("*.nbc*") if path.is_file()}


FORMS = {f"fogbench.worlds.maps.{name}" for name in ("sight.look", "sight.hidden", "cells.passable")}


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """A folder with the sources of `fogbench.worlds`, and nothing that was compiled from them."""
    place = tmp_path / "install"
    place.joinpath("fogbench").mkdir(parents=True)
    for file in Path(fogbench.__file__).parent.glob("__init__.py*"):
        shutil.copy(file, place / "fogbench")
    sources = Path(worlds.__file__).parent
    shutil.copytree(sources, place / "fogbench" / "worlds", ignore=shutil.ignore_patterns("__pycache__"))
    yield place
    for path in [place, *place.rglob("*/")]:
        path.chmod(0o755)


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """An empty folder in which everybody may write."""
    place = tmp_path / "home"
    place.mkdir()
    place.chmod(0o777)
    return place


def seal(folder: Path) -> None:
    """Make a folder read-only, for its owner too."""
    for path in [folder, *folder.rglob("*/")]:
        path.chmod(0o555)


def test_kernels_are_kept_beside_their_source(folder: Path) -> None:
    """Where that can be written, the compiled forms are on disk after the first call, and read by the next process."""
    result = end(start(folder))
    assert result["file"] == str(folder / "fogbench" / "worlds" / "maps" / "cells.py")
    assert Path(result["folder"]).parent == folder / "fogbench" / "worlds" / "__pycache__"
    assert told(result) == COLD
    assert forms(Path(result["folder"])) == FORMS
    assert told(end(start(folder))) == WARM


def test_an_edit_of_another_file_is_noticed(folder: Path) -> None:
    """A constant that a kernel takes from elsewhere is compiled into it, and compiled anew when it changes."""
    before = end(start(folder))
    types = folder / "fogbench" / "worlds" / "types.py"
    types.write_text(types.read_text().replace("UNKNOWN, FREE, BLOCKED = 0, 1, 2", "UNKNOWN, FREE, BLOCKED = 0, 1, 3"))
    after = end(start(folder))
    assert before["folder"] != after["folder"]
    assert after["view"] == [[0, 3, 3], [3, 1, 1], [0, 3, 1]]


@pytest.mark.parametrize(
    "room", ["worlds", "worlds/new", "worlds/maps/families/new", "planners/new", "learned/new/new"]
)
def test_a_file_of_any_room_is_a_source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, room: str) -> None:
    """Whatever folder is added below worlds, planners or learned, its files count; those of `bench` do not."""
    monkeypatch.setattr(kernel, "HERE", tmp_path / "worlds")
    found = []
    for place, text in [("bench", "x = 1"), (room, "x = 1"), (room, "x = 2"), ("bench", "x = 2")]:
        (tmp_path / place).mkdir(parents=True, exist_ok=True)
        (tmp_path / place / "constants.py").write_text(text)
        found.append(kernel._sources())
    assert found[3] == found[2]
    assert len(set(found)) == 3


def play(folder: Path, name: str, lines: list[str]) -> str:
    """What a file of a user's own prints."""
    (folder / f"{name}.py").write_text("\n".join(["from fogbench.worlds.kernel import kernel", *lines]))
    process = start(folder, f"import {name}")
    out, err = process.communicate()
    assert (process.returncode, err) == (0, "")
    return out.strip()


def test_kernels_of_a_users_file_are_kept(folder: Path) -> None:
    """Each by itself, also where they share name and line; an edit of a callee is noticed."""
    lines = [
        "add, take = kernel(lambda x: x + 1), kernel(lambda x: x - 1)",
        "twice = kernel(lambda x: 2 * add(x))",
        "print(twice(20), take(20), add(20), *[sum(each.stats.cache_hits.values()) for each in (twice, take, add)])",
    ]
    assert [play(folder, "mine", lines) for _ in range(2)] == ["42 19 21 0 0 0", "42 19 21 1 1 1"]
    edited = lines[0].replace("+ 1", "+ 1 + 1")  # longer: within one second Python tells two sources by length alone
    assert play(folder, "mine", [edited, *lines[1:]]) == "44 19 22 0 0 0"


def test_kernels_that_hold_kernels_are_kept(folder: Path) -> None:
    """Each with the one that it holds, also where all share their names."""
    lines = [
        "def twice(f):",
        "    return kernel(lambda x: f(f(x)))",
        "up, down = twice(kernel(lambda x: x + 1)), twice(kernel(lambda x: x - 1))",
        "print(up(20), down(20), *[sum(each.stats.cache_hits.values()) for each in (up, down)])",
    ]
    assert [play(folder, "mine", lines) for _ in range(2)] == ["22 18 0 0", "22 18 1 1"]


def test_what_compiles_is_loaded_only_where_it_is_needed(folder: Path) -> None:
    """A process that reads its kernels does without, but for one that calls what is not there yet."""
    lines = [
        "import sys",
        "from fogbench.worlds import numba_doors",
        "loaded = lambda: 'numba.np.arraymath' in sys.modules",
        "told = [kernel(lambda x: x + 0.5)(2), loaded()]",
        "numba_doors.address_of_symbol = lambda name: None",
        "print(*told, kernel(lambda x: x - 0.5)(2), loaded())",
    ]
    assert [play(folder, "mine", lines) for _ in range(2)] == ["2.5 True 1.5 True", "2.5 False 1.5 True"]


def test_what_belongs_to_a_process_is_not_kept(folder: Path) -> None:
    """A kernel that holds an address, or a value that it was made with, is compiled in each process."""
    address = ["from ctypes import CDLL, c_int", "f = CDLL(None).abs", "f.argtypes, f.restype = [c_int], c_int"]
    assert play(folder, "distance", [*address, "print(kernel(lambda a, b: f(a - b))(1, 3))"]) == "2"
    made = ["def plus(n):", "    return kernel(lambda x: x + n)", "print(plus(1)(1), plus(2)(1))"]
    assert play(folder, "sums", made) == "2 3"
    assert not forms(folder)


@pytest.mark.parametrize("variables", [{}, {"HOME": "/proc"}, {"NUMBA_CACHE_DIR": "/proc/kernels"}], ids=str)
def test_a_user_without_rights_gets_the_same_where_nothing_can_be_written(
    folder: Path, variables: dict[str, str]
) -> None:
    """In a read-only installation, with no home or a useless one and on a full disk, it only takes the compilation."""
    seal(folder)
    before = set(folder.rglob("*"))
    result = end(start(folder, WITHOUT_RIGHTS + FULL_DISK + SCRIPT, **variables))
    assert (result["folder"], told(result)) == (None, COLD)
    assert set(folder.rglob("*")) == before


def test_a_user_without_rights_cannot_write_into_the_installation(folder: Path) -> None:
    """The script that takes the rights away does take them away."""
    seal(folder)
    process = start(folder, WITHOUT_RIGHTS + "open('fogbench/worlds/mine', 'w')")
    assert "PermissionError: [Errno 13] Permission denied: 'fogbench/worlds/mine'" in process.communicate()[1]


@pytest.mark.parametrize(
    ("variable", "below"), [("HOME", ".cache/fogbench"), ("XDG_CACHE_HOME", "fogbench"), ("NUMBA_CACHE_DIR", ".")]
)
def test_a_user_without_rights_keeps_kernels_at_home(folder: Path, home: Path, variable: str, below: str) -> None:
    """Where the installation is read-only, the second process compiles nothing, since the user's own place has it."""
    seal(folder)
    for expected in (COLD, WARM):
        result = end(start(folder, WITHOUT_RIGHTS + SCRIPT, **{variable: str(home)}))
        assert (Path(result["folder"]).parent, told(result)) == (home / below, expected)
    assert forms(home) == FORMS
    assert not forms(folder)


def test_a_user_without_rights_reads_what_the_owner_has_compiled(folder: Path) -> None:
    """An installation that was warm before it became read-only is warm for everybody."""
    assert told(end(start(folder))) == COLD
    seal(folder)
    assert told(end(start(folder, WITHOUT_RIGHTS + SCRIPT))) == WARM


def test_broken_files_are_replaced(folder: Path) -> None:
    """A file that was cut short costs one more compilation, and is whole again afterwards."""
    place = Path(end(start(folder))["folder"])
    for path in place.glob("*.nbc"):
        path.write_bytes(path.read_bytes()[:100])
    assert [told(end(start(folder))) for _ in range(2)] == [COLD, WARM]


def test_processes_may_compile_at_once(folder: Path) -> None:
    """Two first processes side by side do not disturb each other, and leave whole files and nothing else."""
    for process in [start(folder) for _ in range(2)]:
        assert end(process)["view"] == VIEW
    result = end(start(folder))
    assert told(result) == WARM
    assert forms(folder) == FORMS
    assert len(list(Path(result["folder"]).iterdir())) == len(FORMS)


def test_kernels_that_nobody_uses_are_removed(folder: Path) -> None:
    """By the next that makes a folder, after a month without use; what is newer, or nothing of ours, stays."""
    cache = folder / "fogbench" / "worlds" / "__pycache__"
    days = {"0" * 16: 31, "1" * 16: 29, "2" * 16: 31, "other": 31, "3" * 40: 31}
    for name in days:
        (cache / name).mkdir(parents=True)
        (cache / name / f"{name}.nbc").touch()
    (cache / ("2" * 16) / "mine.txt").touch()
    for name, age in days.items():
        os.utime(cache / name, times=(time.time() - age * 24 * 3600,) * 2)
    made = Path(end(start(folder))["folder"])
    left = {path.relative_to(cache).as_posix() for path in cache.rglob("*") if path.is_file() and made != path.parent}
    kept = {f"{name}/{name}.nbc" for name in ("1" * 16, "other", "3" * 40)} | {f"{'2' * 16}/mine.txt"}
    assert {name for name in left if not name.endswith(".pyc")} == kept
    assert not (cache / ("0" * 16)).exists()


def test_use_keeps_kernels(folder: Path) -> None:
    """Whoever reads them makes their folder young again; nothing is removed where no folder is made."""
    made = Path(end(start(folder))["folder"])
    old = made.with_name("0" * 16)
    old.mkdir()
    for place in (made, old):
        os.utime(place, times=(0, 0))
    assert told(end(start(folder))) == WARM
    assert time.time() - made.stat().st_mtime < 3600
    assert old.exists()


def test_kernels_may_be_removed_at_any_moment(folder: Path) -> None:
    """A process that runs compiles anew what it misses, and keeps it."""
    remove = "\nimport shutil\nfrom fogbench.worlds.maps.cells import fuse\nplace = used()\nshutil.rmtree(place)\n"
    again = "fuse(np.zeros((3, 3), np.uint8), view, 1, 1)\nassert used() == place\nassert place.exists()"
    assert told(end(start(folder, SCRIPT + remove + again))) == COLD


def test_a_kernel_without_a_file_is_compiled() -> None:
    """What is typed at a prompt can be a kernel too."""
    script = "from fogbench.worlds.kernel import kernel\ntwice = kernel(lambda x: 2 * x)\nprint(twice(21))"
    assert start(Path(fogbench.__file__).parents[1], script).communicate() == ("42\n", "")


def test_loops_fill_the_registers_that_the_processor_has(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of 512 bits too, which LLVM would use by halves on many processors."""
    monkeypatch.setattr(kernel, "FOLDERS", (tmp_path,))  # Numba does not show the code of a form that was kept

    @kernel.kernel
    def triple(numbers: Array) -> None:
        for n in range(len(numbers)):
            numbers[n] *= 3

    triple(np.ones(64, np.float32))
    (code,) = triple.inspect_asm().values()  # type: ignore[attr-defined]  # Numba's
    assert ("zmm" in code) == ("+avx512f" in get_host_cpu_features().split(","))


def test_features_that_somebody_names_are_left(folder: Path) -> None:
    """And kernels for them are kept apart from others."""
    script = SCRIPT + "import numba\nassert numba.config.CPU_FEATURES == ''\n"
    assert told(end(start(folder))) == COLD
    environment = {"NUMBA_CPU_FEATURES": "", "NUMBA_CPU_NAME": "generic"}
    assert told(end(start(folder, script, **environment))) == COLD
    assert told(end(start(folder, script, **environment))) == WARM
