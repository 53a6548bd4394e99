"""Where agents crashed is kept beside the results: once for each, readable, under a name that any disk takes."""

from pathlib import Path
from typing import Any

import pytest

from fogbench.bench.playing.crashes import crash_file
from fogbench.bench.playing.runner import run


def bad(how: str, label: str) -> dict[str, Any]:
    """An entry of the agent that fails in this way."""
    return {"./bad.py:Bad": {"how": how, "label": label}}


def test_the_first_crash_of_each_agent_is_kept(make: Any, tmp_path: Path) -> None:
    """An exception with all its frames, a fault of native code with those of Python; nothing of those who play on."""
    agents = ["astar", bad("act", "a/b"), bad("segfault", "fault"), bad("start", "start"), bad("none", "fine")]
    run(make(agents=agents, episodes=3), tmp_path / "store", 2, lambda progress: None)
    folder = tmp_path / "store" / "crashes"
    assert {file.name for file in folder.iterdir()} == {crash_file("a/b"), "fault.txt", "start.txt"}
    act, fault, start = ((folder / name).read_text() for name in (crash_file("a/b"), "fault.txt", "start.txt"))
    assert act.startswith(("long, episode ", "short, episode "))
    assert act.splitlines()[0].endswith(", a/b")
    assert "ValueError: no\n  act" in act
    assert "Segmentation fault" in fault
    for text, function in ((act, "act"), (fault, "act"), (start, "start")):
        assert "bad.py" in text
        assert f"in {function}" in text


@pytest.mark.parametrize("label", ["..", "a/b", "a-b", "x" * 5000, "ä ö", "a\x00b", "astar, seed 1"])
def test_a_file_for_any_label(label: str) -> None:
    """Short, and without anything that a disk forbids."""
    name = crash_file(label)
    assert len(name.encode()) < 255
    assert not set(name) & set('/\0\\:*?"<>|\n')
    assert name == Path(name).name


def test_labels_do_not_share_a_file() -> None:
    """However alike they are."""
    labels = ["a/b", "a-b", "a b", "a:b", "a--b", "x" * 100, "x" * 101]
    assert len({crash_file(label) for label in labels}) == len(labels)
