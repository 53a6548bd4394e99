"""The command in odd surroundings: it plays what a plain run plays, and nobody meets a traceback or a warning."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pandas as pd
import pytest

import fogbench
from fogbench.bench.playing.episode import TIMINGS

SCENARIO = """
name: odd
about: "Of [red]odd[/red] places: µ, :smile: and $x$."
maps: {blobs: {size: 12, obstacles: [2, 4], obstacle_size: [2, 3]}}
budget: {steps: 60}
agents: [astar, {memoryless: {label: "_Ba$$in — [bold]"}}]
episodes: 3
"""

RECIPE = """
name: small
network: {vin: {size: [5, 5], iterations: 2}}
maps: {blobs: {size: 6, obstacles: [0, 2], obstacle_size: [1, 2]}}
budget: {steps: 8}
learning: {imitation: {batches: 1, batch: 2}}
validation: {episodes: 2, every: 1}
"""

PLAYED = ("run s.yaml --workers 1", "report s.yaml", "replay s.yaml --agent astar")

TOLD = ("check s.yaml", "list", "schema", "run --help")

PLOTS = {"success.png", "path_ratio.png", "success_by_steps.png", "success_by_seconds.png", "by_distance.png"}

ALL = """
import json, sys
from pathlib import Path
from fogbench.bench.command import main

codes = {}
for command in sys.argv[1:]:
    sys.argv = ["fogbench", *command.split()]
    try:
        main()
    except SystemExit as end:
        codes[command] = end.code or 0
Path("codes.json").write_text(json.dumps(codes), "utf-8")
"""
"""Does what each argument says, one after the other, in one process."""


class Odd(NamedTuple):
    """Surroundings that change nothing."""

    environment: dict[str, str]
    files: dict[str, bytes] = {}  # noqa: RUF012  of a table
    """Beside the scenario."""
    commands: tuple[str, ...] = PLAYED
    said: str = "6 were played now"


HOMES = ("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "TMPDIR", "MPLCONFIGDIR")

SURROUNDINGS = {
    "notebook": Odd(
        {"MPLBACKEND": "module://matplotlib_inline.backend_inline"}, commands=(*PLAYED, "train small.yaml"),
    ),
    "latin-1, settings of TeX": Odd(
        {"PYTHONIOENCODING": "latin-1", "COLUMNS": "20", "TERM": "dumb", "MATPLOTLIBRC": "rc", "TZ": "Odd/Place"},
        {"rc": b"text.usetex: True\nbackend: none\n"}, commands=PLAYED + TOLD,
    ),
    "ascii, broken settings": Odd(
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "NO_COLOR": "1", "PYTHONHASHSEED": "7"},
        {"matplotlibrc": b"\xff\xfe: {\nfont.size: huge\n"}, commands=PLAYED + TOLD,
    ),
    "nothing to write to, another language": Odd(
        dict.fromkeys(HOMES, "/dev/null/x")
        | {"PYTHONDONTWRITEBYTECODE": "1", "LC_ALL": "de_DE.UTF-8", "LANGUAGE": "de", "FORCE_COLOR": "1", "LINES": "x"}
    ),
    "warnings are errors": Odd({"PYTHONWARNINGS": "error"}, commands=PLAYED + TOLD),
    "no docstrings": Odd(
        {"PYTHONOPTIMIZE": "2", "OMP_NUM_THREADS": "bogus"}, commands=PLAYED + TOLD, said="Play the episodes that are"
    ),
}  # fmt: skip
"""By name."""

FULL = "the disk: got No space left on device; expected a place to read and write.\n"

NO_FOLDER = "s.yaml/odd: got Not a directory; expected a place that can be written.\n"

ENDS = {
    "a full disk": ("run s.yaml > /dev/full", 2, FULL),
    "a little on a full disk": ("check s.yaml > /dev/full", 2, FULL),
    "nobody reads": ("list | true; exit ${PIPESTATUS[0]}", 141, ""),
    "nobody reads mistakes": ("check nothing.yaml 2>&1 | true; exit ${PIPESTATUS[0]}", 2, ""),
    "nowhere to print": ("check s.yaml >&-", 0, ""),
    "nowhere to complain": ("check nothing.yaml 2> /dev/full", 2, ""),
    "results are a file": ("run s.yaml --workers 1 --results s.yaml > /dev/null", 2, NO_FOLDER),
}  # fmt: skip
"""Name to a line of a shell, its exit code, and all of its error output."""


def surroundings(folder: Path, odd: Odd) -> dict[str, str]:
    """A folder with the scenario and the odd files; returns the environment."""
    (folder / "s.yaml").write_text(SCENARIO, "utf-8")
    (folder / "small.yaml").write_text(RECIPE, "utf-8")
    for name, contents in odd.files.items():
        (folder / name).write_bytes(contents)
    usual = {name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES", "MPLBACKEND")}
    return {**usual, "PYTHONPATH": str(Path(fogbench.__file__).parents[1]), **odd.environment}


def play(folder: Path, odd: Odd) -> tuple[dict[str, int], str, str]:
    """The exit code of each command, all output, all errors."""
    command = [sys.executable, "-c", ALL, *odd.commands]
    run = subprocess.run(command, cwd=folder, env=surroundings(folder, odd), capture_output=True, check=False)
    out, err = run.stdout.decode(errors="replace"), run.stderr.decode(errors="replace")
    assert run.returncode == 0, err
    return json.loads((folder / "codes.json").read_text("utf-8")), out, err


def rows(folder: Path) -> pd.DataFrame:
    """What was recorded."""
    return pd.read_parquet(folder / "results" / "odd" / "episodes").drop(columns=list(TIMINGS))


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    """What a plain run records."""
    folder = tmp_path_factory.mktemp("plain")
    play(folder, Odd({}, commands=("run s.yaml --workers 1",)))
    return rows(folder)


@pytest.mark.parametrize("name", SURROUNDINGS)
def test_odd_surroundings_change_nothing(name: str, plain: pd.DataFrame, tmp_path: Path) -> None:
    """The same rows, all tables and plots, exit code 0, and not a word of it."""
    odd = SURROUNDINGS[name]
    codes, out, err = play(tmp_path, odd)
    assert codes == dict.fromkeys(odd.commands, 0), err
    assert odd.said in out
    assert not any(word in out + err for word in ("Traceback", "Warning", "atplotlib", "usetex", "not drawn"))
    pd.testing.assert_frame_equal(rows(tmp_path), plain)
    files = {file.name for file in (tmp_path / "results" / "odd").iterdir()}
    assert files >= PLOTS | {"summary.md", "summary.csv"}
    assert "\\_Ba\\$\\$in — [bold]" in (tmp_path / "results/odd/summary.md").read_text("utf-8")
    assert (tmp_path / "replay.png").exists()


@pytest.mark.parametrize("name", ENDS)
def test_an_odd_place_for_what_is_printed(name: str, tmp_path: Path) -> None:
    """An exit code that does not blame an agent, and one line at most."""
    line, code, told = ENDS[name]
    environment = surroundings(tmp_path, Odd({"FOGBENCH": f"{sys.executable} -m fogbench"}))
    run = subprocess.run(
        ["bash", "-c", f"$FOGBENCH {line}"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert (run.returncode, run.stderr) == (code, told)


def test_without_matplotlib_there_are_tables(plain: pd.DataFrame, tmp_path: Path) -> None:
    """One line says why there are no plots; only what is nothing but a plot ends with it."""
    (tmp_path / "matplotlib").mkdir()
    first = os.pathsep.join([str(tmp_path), str(Path(fogbench.__file__).parents[1])])
    odd = Odd({"PYTHONPATH": first}, {"matplotlib/__init__.py": b"raise RuntimeError('broken\\nby hand')"})
    codes, out, err = play(tmp_path, odd)
    line = "Matplotlib: got RuntimeError: broken; expected it to load: nothing is drawn."
    assert list(codes.values()) == [0, 0, 2]
    assert (out.count(line), err) == (2, f"{line}\n")
    assert out.index("Results") < out.index(line)
    pd.testing.assert_frame_equal(rows(tmp_path), plain)
    assert "![" not in (tmp_path / "results/odd/summary.md").read_text("utf-8")
