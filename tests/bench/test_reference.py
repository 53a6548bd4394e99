"""What `fogbench list NAME` says of settings."""

import subprocess
import sys
from pathlib import Path

import pytest

import fogbench
from fogbench import learned, planners, worlds
from fogbench.bench.reading.page import Page
from fogbench.bench.reference import Row, rows, show_settings
from fogbench.worlds.conditions import BudgetSettings
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.reading.shapes import shape

NAMES = [
    *worlds.FAMILIES,
    *planners.PLANNERS,
    *learned.LEARNED,
    *learned.LEARNERS,
    "sensor",
    "rules",
    "tasks",
    "budget",
]

MINE = '''
from fogbench import Positive, Settings


class Mine(Settings):
    """An agent of mine."""

    patience: Positive = 100
    """Searches before it gives up."""
'''


@pytest.mark.parametrize("name", [*NAMES, "scenario", "recipe"])
def test_every_name_has_a_page(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    """With its keys; whoever has none says so."""
    show_settings(name)
    assert name in capsys.readouterr().out


def test_a_setting_has_its_bounds_its_default_and_a_word() -> None:
    """Those in blocks below too."""
    found = {row.key: row for row in rows(shape(BudgetSettings))}
    assert found["steps.plus"] == Row(
        "steps.plus", "a whole number from 0 to 1,000,000,000\ndefault: 0", "Steps added to that."
    )
    assert found["hard_seconds"].value == "a number above 0 and up to 1,000,000\ndefault: 300.0"
    assert found["steps"].value.endswith("\nrequired")
    assert all(row.about for row in rows(shape(Page)) if row.key != "published")


@pytest.mark.parametrize("width", ["40", "60", "200"])
def test_a_page_fits_any_terminal(
    width: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """No line is wider, and no letter is lost."""
    monkeypatch.setenv("COLUMNS", width)
    show_settings("tunnel")
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= int(width)
    assert "bends" in "".join(lines)


def test_a_class_of_one_s_own_has_a_page_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """By its file or its module."""
    monkeypatch.chdir(tmp_path)
    Path("mine.py").write_text(MINE)
    for name in ("./mine.py:Mine", "fogbench.planners.astar:AStar"):
        show_settings(name)
    said = capsys.readouterr().out
    assert "patience" in said
    assert "replan" in said


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("macm", "list: got macm; expected one of "),
        ("grid", "grid: the name of a file, which has no settings; read "),
        ("macn-grid", "macn-grid: the name of a file, which has no settings; read "),
        ("./mine.py:Mine", "./mine.py:Mine: expected an existing file (looked for "),
        ("no_such:Mine", "no_such:Mine: expected a module that is installed; there is no no_such."),
    ],
)
def test_a_name_of_nothing_is_told(name: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the nearest, where there is one."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(Mistake) as caught:
        show_settings(name)
    assert str(caught.value).startswith(told)
    assert ("Did you mean macn?" in str(caught.value)) == (name == "macm")


def test_no_network_is_loaded() -> None:
    """The settings of one are told without PyTorch."""
    script = "import sys; from fogbench.bench.reference import show_settings; show_settings('macn'); "
    told = subprocess.check_output(
        [sys.executable, "-c", script + "print('torch' in sys.modules)"],
        env={"PYTHONPATH": str(Path(fogbench.__file__).parents[1])},
        text=True,
    )
    assert told.endswith("False\n")
