"""The promises that the test suite makes about itself."""

import os
import subprocess
import sys
from pathlib import Path

import fogbench

SUITE = """
import pytest


def test_passes():
    pass


@pytest.mark.skip(reason="too hard")
def test_skipped():
    pass


@pytest.mark.maps
def test_of_maps():
    pass
"""


def outcome(folder: Path, text: str, **environment: str) -> tuple[int, str]:
    """Run pytest on a file of tests, beside a copy of the real conftest."""
    conftest = Path(__file__).with_name("conftest.py").read_text()
    (folder / "conftest.py").write_text(conftest)
    (folder / "test_file.py").write_text(text)
    (folder / "pytest.ini").write_text("[pytest]\nmarkers = maps\n")
    kept = {name: value for name, value in os.environ.items() if name != "FOGBENCH_MAPS"}
    place = str(Path(fogbench.__file__).parents[1])
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", str(folder)]
    settings = {**kept, "PYTHONPATH": place, **environment}
    run = subprocess.run(command, check=False, env=settings, cwd=folder, capture_output=True, text=True)
    return run.returncode, run.stdout


def test_a_skipped_test_is_a_failure_with_its_reason(tmp_path: Path) -> None:
    """A skip fails the run and says why."""
    code, text = outcome(tmp_path, SUITE, FOGBENCH_MAPS="somewhere")
    assert code == 1
    assert "test_file.py::test_skipped: got a test that does not run (Skipped: too hard); expected one" in text
    assert "2 passed, 1 error" in text


def test_a_skipped_file_is_a_failure(tmp_path: Path) -> None:
    """A file that skips itself at its import fails the run."""
    code, text = outcome(tmp_path, 'import pytest\n\npytest.skip("no such package", allow_module_level=True)\n')
    assert code == 2
    assert "got a test that does not run (Skipped: no such package)" in text


def test_tests_of_real_maps_are_left_out_aloud(tmp_path: Path) -> None:
    """Without FOGBENCH_MAPS they do not run, and the summary counts them."""
    code, text = outcome(tmp_path, SUITE.replace("@pytest.mark.skip", "# "))
    assert code == 0
    assert "FOGBENCH_MAPS is not set. Tests of real maps that were left out: 1." in text
    assert "2 passed, 1 deselected" in text
