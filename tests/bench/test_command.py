"""The command line, as a user meets it: what it prints, writes, and ends with."""

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

from fogbench.bench.command import main
from fogbench.bench.playing import packages

Fogbench = Callable[..., tuple[int, str, str]]

SMALL = """
name: {name}
about: "Small maps [of mine], [/red] done."
maps: {{blobs: {{size: 6, obstacles: [0, 2], obstacle_size: [1, 2]}}}}
sensor: {{radius: 2}}
budget: {{steps: 30}}
agents: {agents}
episodes: 2
"""

PLANNER = """
from typing import ClassVar
from fogbench.planners.memoryless import Memoryless


class Listed(Memoryless):
    layers: list[int] = [1, 2]


class Broken(Memoryless):
    def start(self, task, rng):
        raise RuntimeError("no start")
"""


@pytest.fixture
def fogbench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Fogbench:
    """Gives a command its arguments in an empty folder: exit code, output, errors."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["fogbench", *arguments])
        with pytest.raises(SystemExit) as end:
            main()
        said = capsys.readouterr()
        return int(end.value.code or 0), said.out, said.err

    return run


def write(name: str, agents: str = "[astar]") -> None:
    """Write a scenario, and the planners that it may name."""
    Path(f"{name}.yaml").write_text(SMALL.format(name=name, agents=agents))
    Path("mine.py").write_text(PLANNER)


def test_a_run_leaves_tables_and_plots_and_goes_on_where_it_was(fogbench: Fogbench) -> None:
    """The second run plays nothing, and more episodes only the rest."""
    write("small")
    for arguments, counts in (
        ([], "0 episodes were recorded before, 2 were played now"),
        ([], "2 episodes were recorded before, 0 were played now"),
        (["--episodes", "3"], "2 episodes were recorded before, 1 were played now"),
    ):
        code, out, _ = fogbench("run", "small.yaml", *arguments)
        assert (code, counts in out, "[of mine], [/red] done" in out) == (0, True, True)
    assert {"summary.csv", "summary.md", "run.json", "success.png"} <= {f.name for f in Path("results/small").iterdir()}
    assert fogbench("report", "small.yaml")[0] == 0


def test_a_report_compares_with_whom_one_asks_for(fogbench: Fogbench) -> None:
    """In a file of its own, beside the report; a label that is none of the scenario's is told with the nearest."""
    write("small", "[astar, frontier, memoryless: {label: no memory}]")
    fogbench("run", "small.yaml")
    before = Path("results/small/summary.md").read_text()
    code, out, _ = fogbench("report", "small.yaml", "--against", "no memory")
    assert (code, "The table is in results/small/against-no-memory.md" in out) == (0, True)
    rows = [line.split("|")[2:4] for line in Path("results/small/against-no-memory.md").read_text().splitlines()[4:]]
    assert [[cell.strip() for cell in row] for row in rows] == [["astar", "no memory"], ["frontier", "no memory"]]
    assert Path("results/small/summary.md").read_text() == before
    code, _, err = fogbench("report", "small.yaml", "--against", "fronteir")
    expected = "expected one of astar, frontier, no memory. Did you mean frontier?"
    assert (code, err) == (2, f"--against, small.yaml: got fronteir; {expected}\n")


def test_who_plays_alone_is_compared_with_nobody(fogbench: Fogbench) -> None:
    """One line, and no empty table."""
    write("small", "[astar]")
    fogbench("run", "small.yaml")
    code, _, err = fogbench("report", "small.yaml", "--against", "astar")
    assert code == 2
    assert (
        err
        == "results/small: no episodes of astar are recorded beside those of another agent; use `fogbench run` first.\n"
    )


def test_results_of_another_machine_stay(fogbench: Fogbench, monkeypatch: pytest.MonkeyPatch) -> None:
    """What differs here is told in one line, by all that read them; only a run would play them again."""
    write("small", "[astar, memoryless]")
    fogbench("run", "small.yaml")
    recorded, told = packages.installed(["numpy"])["numpy"], "Recorded with numpy {}; here is numpy 9.9."
    version = packages._version
    monkeypatch.setattr(packages, "_version", lambda name: "9.9" if name == "numpy" else version(name))
    for arguments in (["report"], ["report", "--against", "astar"], ["replay", "--agent", "astar"]):
        code, out, err = fogbench(*arguments, "small.yaml")
        assert (code, told.format(recorded) in out, "do not count any more" in out, err) == (0, True, False, "")
    assert Path("results/small/summary.csv").read_text().count("success,100.0,") == 2


def test_tables_of_outdated_results_stay(fogbench: Fogbench) -> None:
    """Nothing that is recorded counts any more: one line says so, in place of a page of dashes."""
    write("small")
    fogbench("run", "small.yaml")
    page = Path("results/small/summary.md")
    before = page.read_bytes()
    Path("small.yaml").write_text(Path("small.yaml").read_text() + "seed: 5\n")
    code, out, err = fogbench("report", "small.yaml")
    assert (code, err, page.read_bytes()) == (0, "", before)
    assert out.splitlines()[-1] == (
        "results/small: none of 2 recorded episodes counts any more: settings, files, sources or packages have "
        "changed. The tables stay as they are; `fogbench run` plays the episodes again."
    )


def test_a_plot_that_cannot_be_written_costs_a_line(fogbench: Fogbench) -> None:
    """After the tables, which are whole; the page does without it, and the exit code says that no agent crashed."""
    write("small")
    Path("results/small/success.png").mkdir(parents=True)
    code, out, err = fogbench("run", "small.yaml")
    line = "results/small/success.png: got IsADirectoryError: "
    assert (code, err, out.count(line)) == (0, "", 1)
    assert out.index("Results") < out.index(line)
    page = Path("results/small/summary.md").read_text("utf-8")
    assert ("(success.png)" in page, "(path_ratio.png)" in page) == (False, True)


def test_labels_of_alike_words_have_files_of_their_own(fogbench: Fogbench) -> None:
    """Two that differ by punctuation, and one that is nothing else."""
    write("small", "[astar, memoryless: {label: a b}, frontier: {label: a-b}, random_walk: {label: '?'}]")
    fogbench("run", "small.yaml")
    for label, name in (("a b", "a-b"), ("a-b", "a-b-2"), ("?", "unnamed")):
        code, out, _ = fogbench("report", "small.yaml", "--against", label)
        assert (code, f"against-{name}.md" in out) == (0, True)


def test_a_crash_is_told_and_stays_in_the_exit_code(fogbench: Fogbench) -> None:
    """A later run that plays nothing does not forget it."""
    write("crash", '[astar, "./mine.py:Broken"]')
    for _ in range(2):
        code, out, _ = fogbench("run", "crash.yaml")
        assert (code, "RuntimeError: no start (start, line 12)" in out) == (1, True)


def test_settings_that_cannot_be_hashed_play_like_others(fogbench: Fogbench) -> None:
    """A list among an agent's settings is no reason to stop."""
    write("listed", '["./mine.py:Listed"]')
    assert fogbench("run", "listed.yaml")[0] == 0


def test_what_cannot_be_played_is_told_before_anything_of_it_is(fogbench: Fogbench) -> None:
    """With its place; a check says nothing else, a run plays the other scenarios."""
    write("fine")
    impossible = SMALL.format(name="bad", agents="[astar]") + "tasks: {distance: [90, 99]}\n"
    Path("bad.yaml").write_text(impossible)
    told = (
        "bad.yaml:4:8  maps.blobs: Blobs: no task with an optimum of 90 to 99 cells (set by `tasks: {distance: ...}`) "
        "was found on 1000 maps.\n"
    )
    assert fogbench("check", "bad.yaml", "fine.yaml") == (2, "", told)
    code, out, err = fogbench("run", "bad.yaml", "fine.yaml")
    assert (code, err, "2 were played now" in out) == (2, told, True)
    assert not list(Path("results/bad/episodes").iterdir())


@pytest.mark.parametrize(
    ("workers", "told"), [("100000", "got 100000; expected at most"), ("0", "--workers"), ("-1", "--workers")]
)
def test_workers_have_bounds(workers: str, told: str, fogbench: Fogbench) -> None:
    """More than the machine could hold are refused before any is started."""
    write("small")
    code, _, err = fogbench("run", "small.yaml", "--workers", workers)
    assert (code, told in err) == (2, True)


def test_names_that_are_not_utf_8_are_told(fogbench: Fogbench) -> None:
    """Whether they are given, or lie in a folder that is."""
    name = os.fsdecode(b"caf\xe9.yaml")
    write("small")
    Path("small.yaml").rename(name)
    told = "'caf\\udce9.yaml': got a name that is not UTF-8; expected one that can be printed.\n"
    for place in (name, "."):
        assert fogbench("check", place) == (2, "", told)


def test_a_version_is_said(fogbench: Fogbench) -> None:
    """In one line."""
    code, out, _ = fogbench("--version")
    assert (code, out.count("\n"), out.startswith("fogbench")) == (0, 1, True)


def test_every_mistake_of_every_file_is_told_at_once(fogbench: Fogbench) -> None:
    """One line each, on the error output, and nothing is run."""
    write("one", "[asta]")
    Path("two.yaml").write_bytes(b"\xff")
    code, out, err = fogbench("check", "one.yaml", "two.yaml")
    first, second = err.splitlines()
    assert (code, out) == (2, "")
    assert first.startswith("one.yaml:7:10  agents[0]: got asta; expected one of astar, ")
    assert first.endswith("Did you mean astar?")
    assert second.startswith("two.yaml: got a file that cannot be read (")


def test_a_replay_verifies_and_draws(fogbench: Fogbench) -> None:
    """A strip and a film; an agent that was not recorded is a mistake, and one that is no network has no inside."""
    write("small")
    fogbench("run", "small.yaml")
    for out in ("strip.png", "film.gif"):
        code, said, _ = fogbench("replay", "small.yaml", "--agent", "astar", "--episode", "1", "--out", out)
        assert (code, "It ends as recorded" in said) == (0, True)
        with Image.open(out) as picture:
            assert min(picture.size) > 100
    code, _, err = fogbench("replay", "small.yaml", "--agent", "asta")
    assert (code, err) == (2, "--agent: got asta; expected one of astar. Did you mean astar?\n")
    code, _, err = fogbench("look", "small.yaml", "--agent", "astar")
    nobody = "--agent: got astar, which is not a network of fogbench; expected a class derived from Policy, as "
    nobody += "docs/extending.md tells; none plays here.\n"
    assert (code, err) == (2, nobody)


def test_the_other_commands_answer(fogbench: Fogbench) -> None:
    """They list what there is, say what would be played, describe files to editors, and look at the machine."""
    write("small")
    for arguments, word in (
        (["list"], "dstar_lite"),
        (["list", "dstar_lite"], "dstar_lite has no settings"),
        (["check", "small.yaml"], "2 episodes of 1 agent"),
        (["doctor"], "CPUs"),
    ):
        code, out, _ = fogbench(*arguments)
        assert (code, word in out) == (0, True)
    assert json.loads(fogbench("schema")[1])["type"] == "object"
