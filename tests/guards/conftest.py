"""What the guards share: a desk, which is a folder with files of a user, and the real command that runs there."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd
import psutil
import pytest
import yaml

import fogbench
from fogbench.bench.playing.episode import TIMINGS

PACKAGE = str(Path(fogbench.__file__).parents[1])

SMALL = {
    "name": "small",
    "maps": {"blobs": {"size": 12, "obstacles": [2, 4], "obstacle_size": [2, 3]}},
    "budget": {"steps": 60},
    "agents": ["astar"],
    "episodes": 3,
}

PLANNER = """\
{top}
from typing import ClassVar

from fogbench import BLOCKED, Move, Settings


class Bold(Settings):
    kinds: ClassVar[frozenset[str]] = frozenset({{"grid"}})
    {fields}

    def start(self, task, rng):
        {start}
        return BoldAgent(task.goal)

    def parameter_bytes(self):
        return {weights}


class BoldAgent:
    def __init__(self, goal):
        self.goal = goal

    def act(self, observation):
        (row, column), middle = observation.place, len(observation.view) // 2
        free = [m for m in Move if observation.view[middle + m.delta[0], middle + m.delta[1]] != BLOCKED]
        near = lambda m: abs(row + m.delta[0] - self.goal[0]) + abs(column + m.delta[1] - self.goal[1])
        {act}
        return min(free, key=near, default=None)

    def memory_bytes(self):
        return {memory}

    def search_nodes(self):
        return {search}
"""
"""The planner of the README, with places for something else."""

SLOTS = {"top": "", "fields": "", "start": "", "act": "", "weights": "0", "memory": "0", "search": "0"}


class Ended(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str

    @property
    def lines(self) -> list[str]:
        """Those of its error output."""
        return self.err.splitlines()


class Desk:
    """A folder with files of a user."""

    def __init__(self, folder: Path) -> None:
        """An empty folder."""
        self.folder = folder
        self.clean = {name: value for name, value in os.environ.items() if not name.startswith(("FOGBENCH", "MPL"))}

    def write(self, name: str, text: str) -> Path:
        """Write a file."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def append(self, name: str, text: str) -> None:
        """Add to a file."""
        path = self.folder / name
        path.write_text(path.read_text() + text)

    def scenario(self, file: str = "s.yaml", **changes: Any) -> str:
        """Write a small scenario with changes; None removes a key."""
        page = {key: value for key, value in {**SMALL, **changes}.items() if value is not None}
        self.write(file, yaml.safe_dump(page, sort_keys=False, width=1000))
        return file

    def planner(self, file: str, **slots: str) -> str:
        """Write the planner of the README with something else in some places; how a scenario names it."""
        indented = {name: text.strip("\n").replace("\n", "\n        ") for name, text in slots.items() if name != "top"}
        self.write(file, PLANNER.format(**{**SLOTS, **slots, **indented}))
        return f"./{file}:Bold"

    def start(self, *words: str, **environment: str) -> "subprocess.Popen[str]":
        """Start the command in a session of its own; `PYTHONPATH` is put before the place of the package."""
        path = os.pathsep.join([*filter(None, [environment.pop("PYTHONPATH", "")]), PACKAGE])
        line = [sys.executable, "-m", "fogbench", *words]
        if words[0] == "run" and "--workers" not in words:
            line += ["--workers", "1"]
        return subprocess.Popen(
            line,
            cwd=environment.pop("CWD", str(self.folder)),
            env={**self.clean, "COLUMNS": "200", "PYTHONSAFEPATH": "1", **environment, "PYTHONPATH": path},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            start_new_session=True,
            preexec_fn=_hears_ctrl_c,  # noqa: PLW1509  no thread is near
        )

    def end(self, run: "subprocess.Popen[str]", seconds: float = 120, *, noisy: bool = False) -> Ended:
        """Wait for its end: without a traceback, with a known exit code, and with nothing left of its session.

        What `noisy` planners write to the error output themselves may be anything.
        """
        try:
            out, err = run.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, signal.SIGKILL)
            out, err = run.communicate()
            pytest.fail(f"got no end after {seconds} s; expected one.\n{out[-2000:]}\n{err[-2000:]}")
        said = f"\n{out[-300:]}\n{err[-600:]}"
        left = self.left(run)
        for process in left:
            os.kill(process, signal.SIGKILL)
        if "Traceback" in (out if noisy else out + err):
            pytest.fail(f"got a traceback; expected lines of text.{said}", pytrace=False)
        assert run.returncode in (0, 1, 2, 130), f"got exit code {run.returncode}; expected 0, 1, 2 or 130.{said}"
        assert not left, f"got {len(left)} processes that are left; expected none.{said}"
        return Ended(run.returncode, out, err)

    def left(self, run: "subprocess.Popen[str]", seconds: float = 10) -> list[int]:
        """The processes of a session that still run after some time."""
        end = time.monotonic() + seconds
        while (left := _alive(run.pid)) and time.monotonic() < end:
            time.sleep(0.1)
        return left

    def fogbench(self, *words: str, seconds: float = 120, noisy: bool = False, **environment: str) -> Ended:
        """Run the command to its end."""
        return self.end(self.start(*words, **environment), seconds, noisy=noisy)

    def rows(self, name: str = "small", results: str = "results") -> pd.DataFrame:
        """All recorded columns but the timings, in one order; lists as tuples, so that frames compare."""
        frame = pd.read_parquet(self.folder / results / name / "episodes").drop(columns=list(TIMINGS))
        for column in ("actions", "remaining"):
            frame[column] = frame[column].map(tuple)
        return frame.sort_values(["variant", "agent", "episode"], ignore_index=True)

    def wait(self, ready: Callable[[], bool], seconds: float = 60) -> None:
        """Wait until something is true."""
        end = time.monotonic() + seconds
        while not ready():
            assert time.monotonic() < end, "got nothing to see; expected it to happen"
            time.sleep(0.02)


def _hears_ctrl_c() -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def _alive(session: int) -> list[int]:
    found = []
    for process in psutil.process_iter(["status"]):
        try:
            if os.getsid(process.pid) == session and process.info["status"] != psutil.STATUS_ZOMBIE:
                found.append(process.pid)
        except ProcessLookupError:
            continue
    return found


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    """An empty desk."""
    return Desk(tmp_path)


@pytest.fixture(scope="module")
def desks(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Desk]:
    """Makes empty desks for a whole file of tests."""
    return lambda name: Desk(tmp_path_factory.mktemp(name))
