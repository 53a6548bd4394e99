"""The environment of a command decides nothing."""

import os

import pytest

from fogbench.bench.environment import COMPILED, LEFT, set_environment


def test_options_of_the_compiler_are_put_right_and_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """One line for each that said something else; then there is none."""
    for name in (*COMPILED, *LEFT):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    monkeypatch.setenv("NUMBA_OPT", "3")
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    why = "is ignored: episodes can be compared only if all kernels are compiled alike."
    assert set_environment() == [f"NUMBA_DISABLE_JIT {why}", f"NUMBA_CPU_NAME {why}"]
    assert {name: os.environ.get(name) for name in COMPILED} == COMPILED
    assert "NUMBA_CPU_NAME" not in os.environ
    assert set_environment() == []
