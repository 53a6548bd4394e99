"""What is said of an installation."""

import pytest

from bench.doctor import examine


def test_what_is_missing_is_told_with_the_way_to_get_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The project is installed from its checkout."""
    monkeypatch.setenv("COLUMNS", "160")
    monkeypatch.setattr("bench.doctor._requirements", lambda: ["fog-lamp", 'fog-horn; extra == "noise"'])
    examine()
    rows = [[cell.strip() for cell in row.split("│")] for row in capsys.readouterr().out.splitlines()]
    assert ["", "fog-lamp", "missing: pip install .", "everything", ""] in rows
    assert ["", "fog-horn", 'missing: pip install ".[noise]"', "the extra noise", ""] in rows
