"""A run that is killed or stopped loses nothing that was recorded, and leaves no process behind."""

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import psutil
import pytest

from fogbench.bench.playing.episode import SCHEMA, TIMINGS
from fogbench.bench.playing.pool import AHEAD
from fogbench.bench.playing.store import read
from fogbench.bench.reading.scenario import Scenario

RUN = """
import signal
import sys
from pathlib import Path
from fogbench.bench.playing import recorder
from fogbench.bench.playing.runner import run
from fogbench.bench.reading.scenario import read_scenario
recorder.PAUSE = 0.05  # seconds; else a quick machine is killed each time before it has written anything
signal.signal(signal.SIGINT, signal.default_int_handler)  # the background jobs of a shell are deaf to it
path = Path(sys.argv[1])
try:
    run(read_scenario(path.read_text(), path), Path(sys.argv[2]), 2, lambda progress: None)
except KeyboardInterrupt:
    print("stopped")
"""

LOGGED = '''
import time
from pathlib import Path
from typing import ClassVar

from fogbench.planners.astar import AStarAgent
from fogbench.worlds.settings import Settings


class Logged(Settings):
    """A* that writes a number of its own into a log when it starts, and records it as its search effort."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    def start(self, task, rng):
        agent = LoggedAgent(task, eager=False)
        agent.mark = int(rng.integers(2**48)) * 32 + task.budget.steps  # variants share their luck, not their budget
        with Path(__file__).with_name("log").open("a") as log:
            log.write(f"{agent.mark}\\n")
        time.sleep(0.01)
        return agent

    def parameter_bytes(self):
        return 0


class LoggedAgent(AStarAgent):
    def search_nodes(self):
        return self.mark
'''

Run = Callable[[str], "subprocess.Popen[str]"]


@pytest.fixture
def scenario(make: Any, tmp_path: Path) -> Scenario:
    """Many short episodes of an agent that logs each start."""
    (tmp_path / "logged.py").write_text(LOGGED)
    (tmp_path / "log").touch()
    return make(agents=[{"./logged.py:Logged": {"label": "logged"}}], reference="logged", episodes=200)


@pytest.fixture
def start(scenario: Scenario, tmp_path: Path) -> Run:
    """Starts a run on the named store, in a session of its own."""

    def start(store: str) -> "subprocess.Popen[str]":
        command = [sys.executable, "-c", RUN, str(scenario.path), str(tmp_path / store)]
        return subprocess.Popen(
            command, start_new_session=True, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )

    return start


def finish(run: "subprocess.Popen[str]") -> None:
    """Wait for the end of a run, without a word."""
    assert run.communicate(timeout=120) == ("", "")


def marks(folder: Path) -> list[int]:
    """The numbers of the episodes that were started, in order; those of warm-ups too."""
    return [int(line) for line in (folder / "log").read_text().split()]


def facts(folder: Path, scenario: Scenario) -> pd.DataFrame:
    """All recorded columns but the timings; lists as tuples, so that frames compare."""
    rows = read(folder, scenario, [name for name in SCHEMA.names if name not in TIMINGS])
    return rows.assign(actions=rows["actions"].map(tuple))


def wait_for(ready: Callable[[], bool], seconds: float) -> bool:
    """Whether something comes true in time."""
    end = time.monotonic() + seconds
    while not ready():
        if time.monotonic() > end:
            return False
        time.sleep(0.005)
    return True


def alive(session: int) -> list[int]:
    """The processes of a session that still run."""
    found = []
    for process in psutil.process_iter(["status"]):
        try:
            if os.getsid(process.pid) == session and process.info["status"] != psutil.STATUS_ZOMBIE:
                found.append(process.pid)
        except ProcessLookupError:
            continue
    return found


def kill(run: "subprocess.Popen[str]", starts: int, luck: random.Random, folder: Path) -> None:
    """Kill a run at a random moment after so many starts in the log; all its processes are gone soon."""
    assert wait_for(lambda: len(marks(folder)) >= starts, 60)
    time.sleep(luck.uniform(0, 0.1 if starts else 1.2))  # seconds
    run.kill()
    run.communicate()
    assert wait_for(lambda: not alive(run.pid), 10)


def test_a_run_killed_twenty_times_ends_as_if_never_killed(scenario: Scenario, start: Run, tmp_path: Path) -> None:
    """Killed at random moments, half of them at its start, it has the same rows, and plays no recorded one again."""
    finish(start("whole"))
    whole = facts(tmp_path / "whole", scenario)
    assert len(whole) == 2 * 200
    luck = random.Random(0)
    store = tmp_path / "killed"
    for _ in range(20):
        kept, before = set(facts(store, scenario)["search_nodes"]), len(marks(tmp_path))
        kill(start("killed"), luck.choice([0, before + luck.randrange(1, 30)]), luck, tmp_path)
        assert kept.isdisjoint(marks(tmp_path)[before:])
    assert 0 < len(kept) < len(whole)
    finish(start("killed"))
    pd.testing.assert_frame_equal(facts(store, scenario), whole, check_exact=True)


def test_ctrl_c_records_what_was_played(scenario: Scenario, start: Run, tmp_path: Path) -> None:
    """Ctrl-C reaches all processes of a run; it ends quietly, and lacks only the episodes that were in hand."""
    run = start("stopped")
    assert wait_for(lambda: len(marks(tmp_path)) > 50, 60)
    os.killpg(run.pid, signal.SIGINT)
    assert run.communicate(timeout=20) == ("stopped\n", "")
    assert wait_for(lambda: not alive(run.pid), 10)
    played = set(marks(tmp_path))
    missing = played - set(facts(tmp_path / "stopped", scenario)["search_nodes"])
    assert len(missing) <= 2 * AHEAD + 2  # two of them are the warm-ups
