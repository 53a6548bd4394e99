"""Where episodes come from: what `run.json` says of every session."""

import json
import platform
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest

from fogbench.bench.playing.keys import packages
from fogbench.bench.playing.provenance import differences, noted, read_run, versions_of
from fogbench.bench.playing.store import StoreError
from fogbench.worlds.mistake import Mistake


def test_every_session_is_noted(make: Any, tmp_path: Path) -> None:
    """The file has the scenario's text, and each session's versions, command and times, before it has ended too."""
    scenario = make()
    with noted(tmp_path, scenario, 3):
        begun = json.loads((tmp_path / "run.json").read_text())
    with pytest.raises(KeyboardInterrupt), noted(tmp_path, scenario, 1):
        raise KeyboardInterrupt
    run = json.loads((tmp_path / "run.json").read_text())
    assert (run["scenario"], run["path"]) == ("small", str(tmp_path / "small.yaml"))
    assert run["text"] == (tmp_path / "small.yaml").read_text()
    assert run["seeds"] == {"short": 0, "long": 0}
    first, second = run["sessions"]
    assert [session["workers"] for session in run["sessions"]] == [3, 1]
    assert first == {**begun["sessions"][0], "ended": first["ended"]}
    assert begun["sessions"][0]["ended"] is None
    assert first["started"] <= first["ended"] <= second["ended"]
    assert first["versions"]["python"] == platform.python_version()
    assert first["versions"]["numba"] == version("numba")
    assert {"cpu", "cores", "commit", "command", "system"} <= set(first)


def test_a_run_is_read_as_it_was_noted(make: Any, tmp_path: Path) -> None:
    """Reading gives the whole file; where nothing was run there is one line that says what to do."""
    with pytest.raises(Mistake) as caught:
        read_run(tmp_path)
    assert str(caught.value) == f"{tmp_path}: no run is recorded; use `fogbench run` first."
    with noted(tmp_path, make(), 3):
        assert read_run(tmp_path) == json.loads((tmp_path / "run.json").read_text())


BROKEN = ["{", "[]", '{"sessions": 3}', '{"sessions": []}', '{"seeds": {}, "sessions": []}',
          '{"seeds": {}, "sessions": [{"workers": 1}]}']  # fmt: skip


@pytest.mark.parametrize("text", BROKEN)
def test_a_broken_file_is_named_and_kept(make: Any, tmp_path: Path, text: str) -> None:
    """What is not as an earlier run has written it gives one line, and stays."""
    path = tmp_path / "run.json"
    path.write_text(text)
    with pytest.raises(StoreError) as caught, noted(tmp_path, make(), 1):
        pass
    told = f"{path}: got a broken file; expected what an earlier run has written."
    assert str(caught.value) == told
    with pytest.raises(StoreError) as caught:
        read_run(tmp_path)
    assert str(caught.value) == told
    assert path.read_text() == text


def test_a_session_has_the_versions_of_all_packages_that_its_keys_name(make: Any, tmp_path: Path) -> None:
    """Besides those that are always noted, of which the keys may name none."""
    shelf = 'from fogbench.planners.astar import AStar\n\n\nclass Mine(AStar):\n    """Yes."""\n'
    (tmp_path / "mine.py").write_text(f"import yaml\n{shelf}")
    scenario = make(agents=["./mine.py:Mine"], reference="Mine")
    assert versions_of(tmp_path) is None
    with noted(tmp_path, scenario, 1):
        pass
    found = versions_of(tmp_path)
    assert found is not None
    assert {"numpy", "numba", "pydantic", "yaml"} <= set(packages(scenario)) <= found.keys()
    assert (found["pandas"], found["yaml"]) == (version("pandas"), f"{version('PyYAML')} (PyYAML)")


def test_versions_are_those_of_the_last_session(make: Any, tmp_path: Path) -> None:
    """Where they differ from those here it is told, and where nothing was run nothing is."""
    scenario = make()
    assert differences(tmp_path, scenario) == ""
    for _ in range(2):
        with noted(tmp_path, scenario, 1):
            pass
    assert differences(tmp_path, scenario) == ""
    for session, told in ((0, ""), (1, f"Recorded with numpy 1; here is numpy {version('numpy')}.")):
        run = read_run(tmp_path)
        run["sessions"][session]["versions"]["numpy"] = "1"
        (tmp_path / "run.json").write_text(json.dumps(run))
        assert differences(tmp_path, scenario) == told
