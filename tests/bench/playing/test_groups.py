"""What a planner starts ends with the run, and no clock but its own ends an episode."""

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pandas as pd
import psutil
import pytest

from fogbench.bench.playing import pool
from fogbench.bench.playing.episode import SCHEMA, TIMINGS
from fogbench.bench.playing.runner import run
from fogbench.bench.playing.store import read
from fogbench.bench.reading.scenario import Scenario

RUDE = '''
import multiprocessing, os, random, subprocess, sys, time
from typing import ClassVar

import numpy as np

from fogbench.planners.astar import AStarAgent
from fogbench.worlds.settings import Settings


def square(x):
    return x * x


class Rude(Settings):
    """A* that does something else besides."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})
    how: str
    mark: str = "0"

    def start(self, task, rng):
        agent = RudeAgent(task, eager=False)
        agent.how, agent.mark, agent.drawn = self.how, self.mark, 0
        return agent

    def parameter_bytes(self):
        return 0


class RudeAgent(AStarAgent):
    def act(self, observation):
        if self.how == "slow":
            time.sleep(0.1)
        if self.how == "program":
            subprocess.Popen(["sleep", self.mark])
        if self.how in ("hang", "shy"):
            command = f"sleep {self.mark} & sleep {self.mark}"
            subprocess.run(["sh", "-c", command], check=True)
        if self.how == "crash":
            subprocess.Popen(["sleep", self.mark])
            os._exit(0)
        if self.how == "twins":
            os.fork()
        if self.how in ("fork", "spawn"):
            with multiprocessing.get_context(self.how).Pool(2) as pool:
                self.drawn += sum(pool.map(square, [1, 2]))
        if self.how == "luck":
            words = {f"word {k}" for k in range(20)}
            order = hash(tuple(words)) % 2**16
            self.drawn += random.randrange(10**6) + int(np.random.randint(10**6)) + order
        return super().act(observation)

    def search_nodes(self):
        return self.drawn
'''


@pytest.fixture
def rude(make: Any, tmp_path: Path) -> Callable[..., Scenario]:
    """Makes a scenario of agents that are rude in these ways."""
    (tmp_path / "rude.py").write_text(RUDE)

    def rude(*ways: str, mark: str = "0", hard_seconds: float = 60, **changes: Any) -> Scenario:
        agents = [{"./rude.py:Rude": {"how": how, "mark": mark, "label": how}} for how in ways]
        budget = {"budget": {"steps": 30, "hard_seconds": hard_seconds}}
        return make(**{"agents": agents, "variants": {"one": budget}, "reference": ways[0], "episodes": 1, **changes})

    return rude


@pytest.fixture
def mark() -> Iterator[str]:
    """Seconds that nobody else sleeps."""
    mark = f"98{random.SystemRandom().randrange(10**6):06}"
    yield mark
    for process in sleeping(mark):
        process.kill()


def sleeping(mark: str) -> list[psutil.Process]:
    """The processes that sleep so long."""
    processes = psutil.process_iter(["cmdline", "status"])
    asleep = [each for each in processes if each.info["cmdline"] == ["sleep", mark]]
    return [each for each in asleep if each.info["status"] != psutil.STATUS_ZOMBIE]


def wait_for(ready: Callable[[], Any], seconds: float = 60) -> bool:
    """Whether something comes true in time."""
    end = time.monotonic() + seconds
    while not ready():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def rows(scenario: Scenario, folder: Path, workers: int = 1) -> pd.DataFrame:
    """Run a scenario, and read its facts."""
    run(scenario, folder, workers, lambda progress: None)
    frame = read(folder, scenario, [name for name in SCHEMA.names if name not in TIMINGS])
    return frame.assign(actions=frame["actions"].map(tuple), remaining=frame["remaining"].map(tuple))


def started(scenario: Scenario, folder: Path, workers: int = 1) -> "subprocess.Popen[bytes]":
    """The command, in a session of its own."""
    command = [sys.executable, "-m", "fogbench", "run", str(scenario.path), "--results", str(folder)]
    return subprocess.Popen(
        [*command, "--workers", str(workers)],
        start_new_session=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        preexec_fn=_hears,  # noqa: PLW1509  no threads here
    )


def _hears() -> None:
    """Whoever runs the tests may be deaf to some signals."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


@pytest.mark.parametrize(("how", "outcome"), [("program", "REACHED"), ("hang", "HUNG"), ("crash", "CRASHED")])
def test_nothing_that_a_planner_has_started_is_left(
    how: str, outcome: str, rude: Any, mark: str, tmp_path: Path
) -> None:
    """Where an episode ends well, hangs or takes its process down."""
    frame = rows(rude(how, mark=mark, hard_seconds=2 if how == "hang" else 60), tmp_path / "store")
    assert list(frame["outcome"]) == [outcome]
    assert wait_for(lambda: not sleeping(mark), 5)
    assert not psutil.Process().children(recursive=True) or all(
        "resource_tracker" in " ".join(child.cmdline()) for child in psutil.Process().children(recursive=True)
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_nothing_outlives_the_command(number: int, rude: Any, mark: str, tmp_path: Path) -> None:
    """However it is ended: neither its workers, nor what a planner has started, nor their guardian."""
    command = started(rude("hang", mark=mark), tmp_path / "results")
    assert wait_for(lambda: sleeping(mark))
    family = psutil.Process(command.pid).children(recursive=True)
    assert len(family) >= 3
    os.killpg(command.pid, number)
    command.wait(20)
    _, alive = psutil.wait_procs(family, 10)
    assert not alive
    assert wait_for(lambda: not sleeping(mark), 5)
    assert command.returncode == (130 if number == signal.SIGINT else -number)


def test_an_error_in_the_command_leaves_nothing(rude: Any, mark: str, tmp_path: Path) -> None:
    """As when its progress cannot be drawn."""

    def fails(progress: Any) -> None:
        if progress.outcome:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        run(rude("program", mark=mark), tmp_path / "store", 1, fails)
    assert wait_for(lambda: not sleeping(mark), 5)


def test_a_planner_may_have_processes_of_its_own(rude: Any, tmp_path: Path) -> None:
    """They are forked or spawned, run functions of its file, and change nothing else."""
    frame = rows(rude("none", "fork", "spawn", "twins"), tmp_path / "store", 2).set_index("agent")
    assert set(frame["outcome"]) == {"REACHED"}
    assert len({tuple(actions) for actions in frame["actions"]}) == 1
    steps = frame["steps"].iloc[0]
    assert dict(frame["search_nodes"]) == {"none": 0, "fork": 5 * steps, "spawn": 5 * steps, "twins": 0}


def test_shared_generators_repeat(rude: Any, tmp_path: Path) -> None:
    """One worker, two, and a run that was played in two halves give the same; other episodes other luck."""
    whole = rows(rude("luck", episodes=8), tmp_path / "one", 1)
    assert whole["search_nodes"].nunique() > 4
    pd.testing.assert_frame_equal(rows(rude("luck", episodes=8), tmp_path / "two", 2), whole, check_exact=True)
    rows(rude("luck", episodes=3), tmp_path / "halves", 1)
    pd.testing.assert_frame_equal(rows(rude("luck", episodes=8), tmp_path / "halves", 2), whole, check_exact=True)


def test_a_clock_that_jumps_ends_no_episode(
    rude: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, make: Any
) -> None:
    """A gap in which this process did not run counts for nothing, and the limit still ends who hangs."""
    jumps = [0.0]

    def jumpy() -> float:
        jumps[0] += 3600 * (random.random() < 0.2)
        return time.monotonic() + jumps[0]

    monkeypatch.setattr(pool, "monotonic", jumpy)
    frame = rows(rude("slow", "shy", mark="3600", hard_seconds=6), tmp_path / "store", 2)
    assert jumps[0] > 0
    assert dict(zip(frame["agent"], frame["outcome"], strict=True)) == {"slow": "REACHED", "shy": "HUNG"}


def test_a_command_that_was_stopped_goes_on(rude: Any, tmp_path: Path) -> None:
    """All its processes stand still for longer than the limit, as in a laptop that sleeps; nobody has hung."""
    scenario = rude("slow", hard_seconds=4, episodes=3)
    command = started(scenario, tmp_path / "results")
    assert wait_for(lambda: len(psutil.Process(command.pid).children()) >= 2)
    time.sleep(2.5)
    family = [psutil.Process(command.pid), *psutil.Process(command.pid).children(recursive=True)]
    for process in family:
        process.suspend()
    time.sleep(4.5)
    for process in reversed(family):
        process.resume()
    assert command.wait(60) == 0
    frame = read(tmp_path / "results" / "small", scenario, ["outcome"])
    assert len(frame) == 3
    assert "HUNG" not in set(frame["outcome"])


def test_any_limit_can_be_waited_for(rude: Any, tmp_path: Path) -> None:
    """As large as a limit can be."""
    assert list(rows(rude("none", hard_seconds=1e6), tmp_path / "store")["outcome"]) == ["REACHED"]


def test_who_hangs_first_is_not_asked_again(rude: Any, tmp_path: Path) -> None:
    """Its first three episodes are recorded, all others of everyone else's; the next run plays nothing again."""
    scenario = rude("none", "shy", mark="3600", hard_seconds=1, episodes=6)
    summary = run(scenario, tmp_path / "store", 2, lambda progress: None)
    assert summary.hung == {("one", "shy"): 3}
    frame = read(tmp_path / "store", scenario, ["agent", "episode", "outcome"])
    assert list(frame[frame["agent"] == "shy"]["episode"]) == [0, 1, 2]
    assert len(frame) == 6 + 3
    again = run(scenario, tmp_path / "store", 2, lambda progress: None)
    assert (again.kept, again.outcomes.total(), again.hung) == (9, 0, {("one", "shy"): 3})
