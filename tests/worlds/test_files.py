"""A folder is held by one process at a time; a file is written whole or not at all."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

import fogbench
from fogbench.worlds.files import alone, write
from fogbench.worlds.mistake import Mistake

HOLD = """
import sys
from pathlib import Path
from fogbench.worlds.files import alone

with alone(Path("held"), "run"):
    print("held", flush=True)
    sys.stdin.read()
"""
"""Holds a folder until its input ends."""


def start(folder: Path) -> subprocess.Popen[str]:
    """The script, beside the folder."""
    environment = {"PYTHONPATH": str(Path(fogbench.__file__).parents[1])}
    command, pipe = [sys.executable, "-c", HOLD], subprocess.PIPE
    return subprocess.Popen(command, cwd=folder, env=environment, stdin=pipe, stdout=pipe, stderr=pipe, text=True)


def test_a_second_process_is_refused_until_the_first_dies(tmp_path: Path) -> None:
    """It is told which process holds the folder; one that ends, raises or is killed holds it no more."""
    first = start(tmp_path)
    assert first.stdout is not None
    assert first.stdout.readline() == "held\n"
    _, told = start(tmp_path).communicate()
    line = f"held: got a second run; expected the one in process {first.pid} to end first."
    assert told.splitlines()[-1] == f"fogbench.worlds.mistake.Mistake: {line}"
    first.kill()
    first.communicate()
    assert start(tmp_path).communicate() == ("held\n", "")


def test_a_held_folder_is_let_go(tmp_path: Path) -> None:
    """At the end of the work, also where it raises; a folder beside it was free all along."""
    one, other = tmp_path / "one", tmp_path / "other"
    for _ in range(2):
        with pytest.raises(Mistake) as caught, alone(one, "run"), alone(other, "run"), alone(one, "look"):
            pass
        assert str(caught.value) == f"{one}: got a second look; expected the one in process {os.getpid()} to end first."


def test_a_full_disk_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error, which the system gives no name, has the file's; no draft stays behind."""

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    write(tmp_path / "file", b"old")
    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match="No space left") as caught:
        write(tmp_path / "file", b"new")
    assert caught.value.filename == str(tmp_path / "file")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    assert (tmp_path / "file").read_bytes() == b"old"
