"""Versions of packages, and how they are told where they differ."""

from importlib.metadata import version

import pytest

from fogbench.bench.playing.packages import difference, installed


def test_packages_go_by_the_names_that_they_are_imported_by() -> None:
    """One that is distributed by another name has that beside its version; one that is not here is left out."""
    assert installed(["yaml", "numpy", "nowhere_at_all"]) == {
        "yaml": f"{version('PyYAML')} (PyYAML)",
        "numpy": version("numpy"),
    }


@pytest.mark.parametrize(
    ("recorded", "told"),
    [
        ({}, ""),
        ({"numpy": "1"}, "Recorded with numpy 1; here is numpy {numpy}."),
        ({"numpy": None}, ""),
        (
            {"numpy": "1", "numba": "3", "fog_lamp": "2"},
            "Recorded with fog_lamp 2, numba 3 and numpy 1; here are no fog_lamp, numba {numba} and numpy {numpy}.",
        ),
        (
            {"numpy": "1", "fog_lamp": "2"},
            "Recorded with fog_lamp 2 and numpy 1; here are no fog_lamp and numpy {numpy}.",
        ),
    ],
)
def test_differences_are_told_in_one_line(recorded: dict[str, str | None], told: str) -> None:
    """Of the packages that are asked for alone, in the order of their names; nothing of what was not written down."""
    here = installed(["numpy", "numba"])
    then = {name: found for name, found in {**here, "torch": "0", **recorded}.items() if found}
    assert difference(["numpy", "numba", "fog_lamp"], then) == told.format(**here)
