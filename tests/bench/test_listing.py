"""The tables of what is at hand."""

import subprocess
import sys

import pytest

from fogbench.bench.listing import show
from fogbench.bench.shipped import checkpoints, find, recipes


def test_listing_loads_neither_numbers_nor_settings() -> None:
    """It prints what is written, so it comes at once."""
    heavy = {"numpy", "pydantic", "pandas", "numba"}
    code = f"from fogbench.bench.listing import show; show(); import sys; print(sorted({heavy} & set(sys.modules)))"
    text = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert text.endswith("\n[]\n")


def test_all_that_goes_by_a_name_is_listed(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Scenarios, recipes and checkpoints too."""
    monkeypatch.setenv("COLUMNS", "200")
    show()
    told = capsys.readouterr().out
    names = [path.stem for path in find(None)] + [*recipes(), *checkpoints()]
    assert len(names) > 50
    assert all(name in told for name in names)
