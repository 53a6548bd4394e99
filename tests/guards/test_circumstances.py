"""One scenario under odd circumstances: all columns but timings equal a plain run's, or a line says why not.

A circumstance is one entry of `ODD`.
"""

import os
import random
import signal
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import pandas as pd
import psutil
import pytest

CLOCK = """
import os, time
truth, monotonic, began = time.time, time.monotonic, time.monotonic()
time.time = lambda: truth() + (float(os.environ["JUMP"]) if monotonic() - began > 2 else 0)
"""
"""A `sitecustomize` in which the system's clock takes a step."""

SLOW = """import time; time.sleep(float(os.environ.get('PAUSE', 0))); print('\u2192'); os.write(1, b'.')
with open(LOG, 'a') as log: log.write('x')"""
TOP = "import os, random, numpy\nLOG = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'log')"
LUCKY = "return random.choice(free) if numpy.random.random() < 0.2 else min(free, key=near)"

MAP = "type octile\nheight 8\nwidth 12\nmap\n" + "............\n" * 3 + "..@@@@@@@...\n" * 2 + "............\n" * 3
SCEN = "version 1\n" + "".join(f"0\ta.map\t12\t8\t{k}\t0\t{11 - k}\t7\t9\n" for k in range(4))

PAUSE = "0.05"
"""Seconds before each decision of the slow planner, where something happens while it plays."""

Step = Callable[[Any, Any], None]


class Odd(NamedTuple):
    """What is odd about a run."""

    environment: dict[str, str] = {}  # noqa: RUF012  a named tuple is not changed
    """`FOLDER` in it stands for the desk's folder."""
    words: tuple[str, ...] = ()
    """More words of the command."""
    meanwhile: Step | None = None
    """What happens as soon as the first decision was taken: given the desk and the process."""
    refusal: str = ""
    """A word of the line that says why not, where a run may stop."""


def suspend(desk: Any, run: Any) -> None:
    """Ctrl-Z, some seconds of something else, fg."""
    os.killpg(run.pid, signal.SIGSTOP)
    time.sleep(6)
    os.killpg(run.pid, signal.SIGCONT)


def stop_and_go(desk: Any, run: Any) -> None:
    """Suspended many times, shortly."""
    for _ in range(10):
        os.killpg(run.pid, signal.SIGSTOP)
        time.sleep(0.1)
        os.killpg(run.pid, signal.SIGCONT)
        time.sleep(0.05)


def ctrl_c(desk: Any, run: Any) -> None:
    """Ctrl-C, which all processes of the terminal hear."""
    os.killpg(run.pid, signal.SIGINT)


def kill(desk: Any, run: Any) -> None:
    """`kill -9` of the command."""
    time.sleep(random.Random(3).random())
    run.kill()


def terminate(desk: Any, run: Any) -> None:
    """`kill` of the command."""
    run.terminate()


def unread(desk: Any, run: Any) -> None:
    """`| head -1`: nobody reads any more what is printed, by the command or by a planner."""
    run.stdout.close()


def idle(desk: Any, run: Any) -> None:
    """A signal that means nothing: the window is resized."""
    os.killpg(run.pid, signal.SIGWINCH)


def edit(name: str, text: str) -> Step:
    """A file is saved again with something more."""
    return lambda desk, run: desk.append(name, text)


def touch(desk: Any, run: Any) -> None:
    """A file is saved again as it is."""
    place = desk.folder / "slow.py"
    place.write_text(place.read_text())


def remove(desk: Any, run: Any) -> None:
    """The scenario goes away."""
    (desk.folder / "s.yaml").unlink()


def second(desk: Any, run: Any) -> None:
    """Somebody else runs the same before this run has ended, however slow that is, and is told so."""
    os.killpg(run.pid, signal.SIGSTOP)
    code = desk.fogbench("run", "s.yaml").code
    os.killpg(run.pid, signal.SIGCONT)
    assert code == 2


ODD = {
    "two workers": Odd(words=("--workers", "2")),
    "three workers": Odd(words=("--workers", "3")),
    "suspended": Odd(meanwhile=suspend),
    "suspended often": Odd(meanwhile=stop_and_go),
    "clock ahead": Odd({"PYTHONPATH": "FOLDER/clock", "JUMP": "36000", "PAUSE": PAUSE}),
    "clock back": Odd({"PYTHONPATH": "FOLDER/clock", "JUMP": "-36000", "PAUSE": PAUSE}),
    "ctrl-c": Odd(meanwhile=ctrl_c),
    "killed": Odd(meanwhile=kill),
    "terminated": Odd(meanwhile=terminate),
    "unread": Odd(meanwhile=unread),
    "window resized": Odd(meanwhile=idle),
    "planner edited": Odd(meanwhile=edit("slow.py", "\n\nMORE = 1\n"), refusal="slow.py"),
    "planner saved": Odd(meanwhile=touch),
    "map edited": Odd(meanwhile=edit("a.map", "............\n"), refusal="a.map"),
    "tasks edited": Odd(
        meanwhile=edit("a.map.scen", "0\ta.map\t12\t8\t9\t0\t0\t0\t9\n"), refusal="got other sources, files or packages"
    ),
    "scenario edited": Odd(meanwhile=edit("s.yaml", "seed: 5\n"), refusal="s.yaml"),
    "scenario removed": Odd(meanwhile=remove, refusal="s.yaml"),
    "run twice": Odd(meanwhile=second),
    "nice": Odd(meanwhile=lambda desk, run: os.setpriority(os.PRIO_PGRP, run.pid, 19)),
    "elsewhere": Odd({"CWD": "/"}),
    "turkish": Odd({"LC_ALL": "tr_TR.UTF-8", "LANG": "tr_TR.UTF-8"}),
    "no utf-8": Odd({"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONIOENCODING": "ascii"}),
    "no home": Odd({"HOME": "/no/such/home", "XDG_CACHE_HOME": "/no/such/cache", "MPLCONFIGDIR": "/no/such/config"}),
    "home is a file": Odd({"HOME": "/dev/null", "XDG_CACHE_HOME": "/dev/null"}),
    "no terminal": Odd({"TERM": "dumb", "COLUMNS": "1", "NO_COLOR": "1"}),
    "colours": Odd({"FORCE_COLOR": "1", "COLUMNS": "20"}),
    "warnings are errors": Odd({"PYTHONWARNINGS": "error"}),
    "development": Odd({"PYTHONDEVMODE": "1"}),
    "optimized": Odd({"PYTHONOPTIMIZE": "2"}),
    "hashed": Odd({"PYTHONHASHSEED": "1234"}),
    "no bytecode": Odd({"PYTHONDONTWRITEBYTECODE": "1"}),
    "unbuffered": Odd({"PYTHONUNBUFFERED": "1"}),
    "many threads": Odd({"OMP_NUM_THREADS": "7", "MKL_NUM_THREADS": "7", "NUMBA_NUM_THREADS": "2"}),
    "numba off": Odd({"NUMBA_DISABLE_JIT": "1"}, refusal="NUMBA_DISABLE_JIT"),
    "other time zone": Odd({"TZ": "Pacific/Kiritimati"}),
    "a backend that is none": Odd({"MPLBACKEND": "none.such"}),
}
"""By a name."""


def kill_worker(run: Any) -> None:
    """`kill -9` of one worker."""
    children = psutil.Process(run.pid).children(recursive=True)
    busy = max(children, key=lambda child: child.memory_info().rss)
    busy.kill()


def prepare(desk: Any) -> None:
    """A scenario of two variants, one on a map file, with A*, luck of its own and a planner that leaves a trace."""
    slow = desk.planner("slow.py", top=TOP, act=SLOW)
    lucky = desk.planner("lucky.py", top=TOP, act=LUCKY)
    variants = {"drawn": {}, "file": {"maps": {"movingai": {"map": "a.map"}}}}
    agents = ["astar", "random_walk", {slow: {"label": "slow"}}, {lucky: {"label": "lucky"}}]
    budget = {"steps": 60, "hard_seconds": 5}
    desk.write("a.map", MAP)
    desk.write("a.map.scen", SCEN)
    desk.write("clock/sitecustomize.py", CLOCK)
    desk.scenario(variants=variants, agents=agents, rules={"collision": "blocked"}, budget=budget, episodes=2)


@pytest.fixture(scope="module")
def plain(desks: Callable[[str], Any]) -> pd.DataFrame:
    """The rows of a plain run."""
    desk = desks("plain")
    prepare(desk)
    ended = desk.fogbench("run", "s.yaml")
    assert (ended.code, ended.err) == (0, "")
    return desk.rows()


@pytest.mark.parametrize("name", ODD)
def test_odd_circumstances_change_no_row(name: str, desk: Any, plain: pd.DataFrame) -> None:
    """What is recorded is what a plain run records; a run that was stopped ends so when it is run again."""
    odd = ODD[name]
    prepare(desk)
    results = str(desk.folder / "results")
    environment = {key: value.replace("FOLDER", str(desk.folder)) for key, value in odd.environment.items()}
    if odd.meanwhile or odd.words:
        environment["PAUSE"] = PAUSE
    run = desk.start("run", str(desk.folder / "s.yaml"), "--results", results, *odd.words, **environment)
    if odd.meanwhile:
        desk.wait((desk.folder / "log").exists)
        odd.meanwhile(desk, run)
    if odd.meanwhile in (kill, terminate, unread):  # it says nothing
        run.communicate(timeout=30)
        assert not desk.left(run)
    else:
        ended = desk.end(run)
        assert ended.code in {0, 130 if odd.meanwhile is ctrl_c else 0, 2 if odd.refusal else 0}, ended.err
        if ended.code == 2:
            assert len(ended.lines) == 1
            assert odd.refusal in ended.err
    if odd.refusal:  # what was edited is as it was again
        prepare(desk)
    if odd.meanwhile or odd.refusal:
        assert desk.fogbench("run", "s.yaml").code == 0
    pd.testing.assert_frame_equal(desk.rows(), plain, check_exact=True)


def test_a_worker_that_is_killed_costs_its_episode(desk: Any, plain: pd.DataFrame) -> None:
    """The episode that it was playing says so, and all others are as ever."""
    prepare(desk)
    run = desk.start("run", "s.yaml", PAUSE=PAUSE)
    desk.wait((desk.folder / "log").exists)
    kill_worker(run)
    ended = desk.end(run)
    rows = desk.rows()
    killed = rows["detail"].str.contains("SIGKILL")
    assert killed.sum() <= 1
    assert ended.code == killed.sum()
    pd.testing.assert_frame_equal(rows[~killed], plain[~killed], check_exact=True)
