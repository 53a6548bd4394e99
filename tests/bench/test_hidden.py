"""A file of the user's that has the name of a library."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import fogbench

SCENARIO = """
name: small
maps: {blobs: {size: 6, obstacles: [0, 2], obstacle_size: [1, 2]}}
budget: {steps: 9}
agents: [astar]
episodes: 1
"""


@pytest.mark.parametrize("name", ["numpy", "yaml", "torch", "random"])
def test_a_hidden_library_is_named(name: str, tmp_path: Path) -> None:
    """In one line and with exit code 2, wherever it comes to light."""
    (tmp_path / f"{name}.py").write_text("VALUE = 1\n")
    (tmp_path / "small.yaml").write_text(SCENARIO)
    path = os.pathsep.join([str(tmp_path), str(Path(fogbench.__file__).parents[1])])
    done = subprocess.run(
        [sys.executable, "-m", "fogbench", "check", "small.yaml"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    told = (
        f"{tmp_path / name}.py: got a file that hides the library {name}; rename it, or take its folder off PYTHONPATH."
    )
    assert (done.returncode, done.stderr.splitlines()[-1:]) == (2, [told])
