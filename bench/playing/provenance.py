"""Where recorded episodes come from: the scenario's text, the machine, the versions, the times."""

import json
import os
import platform
import shlex
import subprocess
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from pydantic import BaseModel, Field

from fogbench.bench.playing.keys import packages
from fogbench.bench.playing.packages import difference, installed
from fogbench.bench.playing.store import StoreError, write
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.mistake import Mistake

PACKAGES = (
    "fogbench",
    "numpy",
    "numba",
    "scipy",
    "networkx",
    "pandas",
    "pyarrow",
    "pydantic",
    "ompl",
    "torch",
)
"""Packages whose versions are always written down, where they are installed; with those that are in the keys."""


class _Session(BaseModel):
    """What a report tells of each session."""

    workers: int
    cpu: str
    cores: int | None
    system: str
    commit: str | None
    versions: dict[str, str]


class _Run(BaseModel):
    """What a report tells of a run."""

    seeds: dict[str, int]
    sessions: list[_Session] = Field(min_length=1)


def read_run(folder: Path) -> dict[str, Any]:
    """The content of `run.json` in the folder of a scenario.

    Raises:
        Mistake: nothing was run there.
        StoreError: the file is broken.
    """
    path = folder / "run.json"
    if not path.exists():
        raise Mistake(f"{folder}: no run is recorded; use `fogbench run` first.")
    try:
        text = path.read_text("utf-8")
        _Run.model_validate_json(text)
        return dict(json.loads(text))
    except (ValueError, OSError):
        raise StoreError(f"{path}: got a broken file; expected what an earlier run has written.") from None


def versions_of(folder: Path) -> dict[str, str] | None:
    """The versions of packages in the last session of a folder; None where nothing was run there.

    Raises:
        StoreError: `run.json` is broken.
    """
    if not (folder / "run.json").exists():
        return None
    return dict(read_run(folder)["sessions"][-1]["versions"])


def differences(folder: Path, scenario: Scenario) -> str:
    """Which packages the last session had in other versions than there are here, in one line; empty if none.

    Raises:
        StoreError: `run.json` is broken.
    """
    versions = versions_of(folder)
    return "" if versions is None else difference(packages(scenario), versions)


@contextmanager
def noted(folder: Path, scenario: Scenario, workers: int) -> Iterator[None]:
    """Write into `run.json` what is run, on what and when; `ended` stays empty where a run was killed.

    Raises:
        StoreError: the file that is there is broken, or it cannot be written.
    """
    path = folder / "run.json"
    earlier = read_run(folder)["sessions"] if path.exists() else []
    session = {"started": _now(), "ended": None, "workers": workers, **circumstances(packages(scenario))}
    run = {
        "scenario": scenario.name,
        "path": str(scenario.path),
        "text": scenario.text,
        "seeds": {variant.name: variant.seed for variant in scenario.variants},
        "sessions": [*earlier, session],
    }
    _write(path, run)
    try:
        yield
    finally:
        session["ended"] = _now()
        _write(path, run)


def _write(path: Path, run: dict[str, Any]) -> None:
    write(path, json.dumps(run, indent=2, ensure_ascii=False).encode())


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")


def circumstances(others: Iterable[str] = ()) -> dict[str, Any]:
    """The command, the commit, the machine and the versions; those of `others` besides `PACKAGES`."""
    return {
        "command": shlex.join(["fogbench", *sys.argv[1:]]),
        "commit": _commit(),
        "cpu": _cpu(),
        "cores": os.cpu_count(),
        "system": platform.platform(),
        "versions": {"python": platform.python_version(), **installed([*PACKAGES, *others])},
    }


def _cpu() -> str:
    """The model of the CPU, as far as the system tells."""
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
    except OSError:
        lines = []
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.processor())


def _commit() -> str | None:
    """The git commit of the folder where the command was given, with `-dirty` after it if files differ."""
    command = ["git", "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]
    try:
        answer = subprocess.run(command, capture_output=True, text=True, check=True)  # noqa: S603  a fixed command
    except (OSError, subprocess.CalledProcessError):
        return None
    return answer.stdout.strip()
