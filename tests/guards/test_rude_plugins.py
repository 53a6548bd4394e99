"""Plug-ins that misbehave: each costs its own episodes and no others, or is refused in a line.

A rude planner is one entry of `RUDE`: what it does in place of a part of the README's planner, how its episode ends,
and a word of the reason. All play together, a healthy agent after each; if that goes wrong, each plays alone, so that
a failure names who did it. A plug-in that is refused is one entry of `REFUSED`.

Not guarded: a planner that changes the classes of fogbench, or ends the process as its file is imported. Both are more
than rude.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import pandas as pd
import pytest

CRASHED, HUNG = {"CRASHED"}, {"HUNG"}
FINE = {"REACHED"}
EITHER = CRASHED | FINE
LOST = CRASHED | HUNG


class Rude(NamedTuple):
    """How a planner misbehaves."""

    outcomes: set[str]
    """Of which its episode has one."""
    detail: str = ""
    """Part of the reason."""
    act: str = ""
    """What it does first when it decides."""
    parts: dict[str, str] = {}  # noqa: RUF012  a named tuple is not changed
    """Other parts of the planner; see `PLANNER` in conftest.py."""


RUDE = {
    # what an agent says
    "raises": Rude(CRASHED, "ValueError: no act (act, line", "raise ValueError('no act')"),
    "raises_at_start": Rude(CRASHED, "RuntimeError: no start", "", {"start": "raise RuntimeError('no start')"}),
    "raises_in_memory": Rude(CRASHED, "ZeroDivisionError", "", {"memory": "1 // 0"}),
    "raises_in_search": Rude(CRASHED, "ZeroDivisionError", "", {"search": "1 // 0"}),
    "raises_in_weights": Rude(CRASHED, "ZeroDivisionError", "", {"weights": "1 // 0"}),
    "says_north": Rude(CRASHED, "TypeError: act returned 'north'", "return 'north'"),
    "says_nan": Rude(CRASHED, "TypeError: act returned nan", "return float('nan')"),
    "says_much": Rude(CRASHED, "TypeError: act returned", "return 'x' * 10**7"),
    "says_ten_to_the_5000": Rude(CRASHED, "Error: ", "return 10**5000"),
    "says_true": Rude(CRASHED, "TypeError: act returned True", "return True"),
    "says_array": Rude(CRASHED, "TypeError: act returned", "import numpy; return numpy.int64(1)"),
    "says_what_has_no_name": Rude(
        CRASHED, "", "return Nameless()", {"top": "class Nameless:\n    def __repr__(self): return 1 // 0\n"}
    ),
    "counts_less_than_nothing": Rude(CRASHED, "memory_bytes returned -1", "", {"memory": "-1"}),
    "counts_nan": Rude(CRASHED, "memory_bytes returned nan", "", {"memory": "float('nan')"}),
    "counts_too_much": Rude(CRASHED, "memory_bytes returned", "", {"memory": "2**64"}),
    "counts_in_numpy": Rude(FINE, "", "", {"top": "import numpy", "memory": "numpy.int32(7)"}),
    "has_no_act": Rude(CRASHED, "AttributeError", "", {"start": "return object()"}),
    "starts_otherwise": Rude(CRASHED, "TypeError", "", {"fields": "def begin(self): pass\n", "start": "int([])"}),
    # what it raises
    "raises_base": Rude(CRASHED, "BaseException: done", "raise BaseException('done')"),
    "raises_interrupt": Rude(CRASHED, "KeyboardInterrupt", "raise KeyboardInterrupt"),
    "raises_generator_exit": Rude(CRASHED, "GeneratorExit", "raise GeneratorExit"),
    "raises_stop": Rude(CRASHED, "StopIteration", "next(iter([]))"),
    "raises_deep": Rude(CRASHED, "RecursionError", "f = lambda: f(); f()"),
    "raises_memory": Rude(CRASHED, "MemoryError", "bytearray(2**60)"),
    "raises_without_text": Rude(
        CRASHED,
        "Mute: no text",
        "raise Mute",
        {"top": "class Mute(Exception):\n    def __str__(self): return 1 // 0\n"},
    ),
    "raises_what_cannot_travel": Rude(
        CRASHED, "Lone", "raise Lone", {"top": "class Lone(Exception):\n    __reduce__ = None\n    own = lambda: 0\n"}
    ),
    "raises_a_book": Rude(CRASHED, "ValueError: xxx", "raise ValueError('x' * 100_000_000)"),
    "raises_lines": Rude(CRASHED, "ValueError: a b [/red] $x$", r"raise ValueError('a\n\n b [/red] $x$ \x1b[31m')"),
    "raises_a_name_of_lines": Rude(CRASHED, "", "raise type('A\\nB', (Exception,), {})()"),
    "raises_a_surrogate": Rude(CRASHED, "ValueError: ", r"raise ValueError('\ud800')"),
    "writes_into_the_view": Rude(CRASHED, "read-only", "observation.view[:] = 1"),
    "unlocks_the_view": Rude(FINE, "", "observation.view.setflags(write=True)"),
    # how it ends its process
    "exits": Rude(CRASHED, "SystemExit", "import sys; sys.exit(0)"),
    "exits_at_once": Rude(CRASHED, "exit code", "import os; os._exit(0)"),
    "kills_itself": Rude(CRASHED, "SIGKILL", "import os; os.kill(os.getpid(), 9)"),
    "aborts": Rude(CRASHED, "SIGABRT", "import os; os.abort()"),
    "segfaults": Rude(CRASHED, "SIGSEGV", "import ctypes; ctypes.string_at(0)"),
    "kills_its_group": Rude(CRASHED, "SIG", "import os; os.killpg(os.getpgrp(), 15)"),
    "stops_itself": Rude(HUNG, "6 s", "import os; os.kill(os.getpid(), 19)"),
    "loops": Rude(HUNG, "6 s", "while True: pass"),
    "sleeps": Rude(HUNG, "6 s", "import time; time.sleep(1e6)"),
    "holds_the_lock": Rude(HUNG, "6 s", "import collections, itertools; collections.deque(itertools.repeat(0), 0)"),
    "is_deaf": Rude(
        HUNG, "6 s", "import signal, time; [signal.signal(s, signal.SIG_IGN) for s in (2, 15)]; time.sleep(1e6)"
    ),
    "closes_all": Rude(LOST, "", "import os; os.closerange(3, 256)"),
    "has_a_twin": Rude(EITHER | HUNG, "", "import os; observation.step or os.fork()"),
    # what it leaves behind
    "prints": Rude(FINE, "", "import sys; print('x' * 10**6); sys.stderr.write('y' * 10**6)"),
    "prints_orders": Rude(FINE, "", r"print('\x1b[2J\x1b[31m[/red]')"),
    "closes_its_mouth": Rude(
        FINE, "", "import os; [os.close(fd) for fd in (0, 1, 2) if os.path.exists(f'/dev/fd/{fd}')]"
    ),
    "closes_its_streams": Rude(FINE, "", "import sys; sys.stdin.close(); sys.stdout.close(); sys.stderr.close()"),
    "prints_after": Rude(FINE, "", "print('x')"),
    "has_no_streams": Rude(FINE, "", "import sys; sys.stdin = sys.stdout = sys.stderr = None"),
    "starts_threads": Rude(
        FINE, "", "import threading, time; threading.Thread(target=time.sleep, args=(1e6,)).start()"
    ),
    "starts_a_program": Rude(FINE, "", "import subprocess; subprocess.Popen(['sleep', '4321'])"),
    "has_a_pool": Rude(
        FINE,
        "",
        "import multiprocessing\nif not observation.step:\n"
        "    pool = multiprocessing.Pool(1); pool.map(abs, [1]); pool.close(); pool.join()",
    ),
    "leaves_a_pool": Rude(FINE, "", "import multiprocessing; self.pool = observation.step or multiprocessing.Pool(1)"),
    "moves": Rude(FINE, "", "import os; os.chdir('/')"),
    "moves_on_import": Rude(FINE, "", "", {"top": "import os; os.chdir('/')"}),
    "sets_variables": Rude(
        FINE,
        "",
        "import os; os.environ.update(OMP_NUM_THREADS='64', MPLBACKEND='none', PYTHONPATH='', PYTHONHASHSEED='x')",
    ),
    "sets_variables_on_import": Rude(
        FINE,
        "",
        "",
        {"top": "import os; os.environ.update(OMP_NUM_THREADS='9', MPLBACKEND='none', PYTHONPATH='/none')"},
    ),
    "clears_variables": Rude(FINE, "", "import os; os.environ.clear()"),
    "seeds": Rude(FINE, "", "import random, numpy; random.seed(1); numpy.random.seed(1)"),
    "makes_numpy_raise": Rude(FINE, "", "import numpy; numpy.seterr(all='raise')"),
    "makes_warnings_raise": Rude(FINE, "", "import warnings; warnings.simplefilter('error')"),
    "makes_stacks_short": Rude(EITHER, "", "import sys; sys.setrecursionlimit(60)"),
    "takes_print": Rude(FINE, "", "import builtins; builtins.print = None"),
    "takes_json": Rude(FINE, "", "import json; json.dumps = json.loads = None"),
    "takes_numpy": Rude(FINE, "", "import sys; sys.modules['numpy'] = None"),
    "takes_the_path": Rude(FINE, "", "import sys; sys.path.clear()"),
    "handles_signals": Rude(FINE, "", "import signal; [signal.signal(s, lambda *_: None) for s in (2, 14, 15)]"),
    "sets_an_alarm": Rude(FINE, "", "import signal; signal.alarm(1)"),
    "traces": Rude(CRASHED, "ZeroDivisionError", "import sys; sys.settrace(lambda *_: 1 // 0)"),
    "collects_no_garbage": Rude(FINE, "", "import gc; gc.disable()"),
    "speaks_german": Rude(FINE, "", "import locale; locale.setlocale(locale.LC_ALL, 'C')"),
    "hides_files": Rude(FINE, "", "import os; os.umask(0o777)"),
    "logs": Rude(FINE, "", "import logging; logging.basicConfig(level=0); logging.info('loud')"),
    "draws": Rude(
        FINE, "", "", {"top": "import matplotlib\nmatplotlib.use('svg')\nmatplotlib.rcParams['text.usetex'] = True"}
    ),
    "keeps_all": Rude(FINE, "", "self.all = [*getattr(self, 'all', []), observation]"),
    # what its settings are
    "cannot_be_hashed": Rude(FINE, "", "", {"fields": "own: dict[str, int] = {'a': 1}"}),
    "has_a_label_of_markup": Rude(FINE, "", "", {"fields": "own: str = '[/red]$x$'"}),
}
"""By a name, which is the name of its file and its label."""

TORCH = {
    "in_double": "torch.set_default_dtype(torch.float64)",
    "elsewhere": "torch.set_default_device('meta')",
    "on_many_threads": "torch.set_num_threads(8)",
    "in_one_way": "torch.use_deterministic_algorithms(True)",
    "with_its_own_seed": "torch.manual_seed(1)",
}
"""What a planner may do to torch, beside a network."""

FILE = "from fogbench import *\nfrom fogbench import Settings, SquareMaps, Layout\nfrom typing import ClassVar, Any\n"

MAPS = FILE + "class M(SquareMaps):\n    def draw(self, rng, conditions):\n        {}\n"

AGENT = (
    FILE
    + "class A(Settings):\n    kinds: ClassVar = frozenset({{'grid'}})\n    {}\n    def start(self, task, rng): {}\n"
)
AGENT += "    def parameter_bytes(self): return 0\n"


REFUSED = {
    "raises_on_import": "raise RuntimeError('no\\nimport')",
    "exits_on_import": "import sys; sys.exit(0)",
    "ends_on_import": "raise BaseException('no import')",
    "generator_exit_on_import": "raise GeneratorExit",
    "has_no_syntax": "def",
    "has_a_nul": "a = '\0'",
    "is_empty": "",
    "has_no_class": "A = 5",
    "has_a_plain_class": "class A: pass",
    "has_no_start": FILE + "class A(Settings):\n    kinds: ClassVar = frozenset({'grid'})\n",
    "has_no_kinds": AGENT.format("kinds: ClassVar = None", "return None"),
    "has_numbers_for_kinds": AGENT.format("kinds: ClassVar = frozenset({1})", "return None"),
    "has_fields_without_types": AGENT.format("own = threading", "return None"),
    "validates_badly": AGENT.format(
        "def model_post_init(self, context): raise RuntimeError('no\\nlamp')", "return None"
    ),
    "hides_its_fields": AGENT.format("def __getattribute__(self, name): raise RuntimeError(name)", "return None"),
    "cannot_be_words": AGENT.format("def words(self): raise RuntimeError('wordless')", "return None"),
    "has_words_of_numbers": AGENT.format("def words(self): return 5", "return None"),
    "maps_raise": MAPS.format("raise RuntimeError('no\\nmap')"),
    "maps_exit": MAPS.format("raise SystemExit(0)"),
    "maps_are_none": MAPS.format("return None"),
    "maps_are_numbers": MAPS.format("return Layout(5)"),
    "maps_are_lists": MAPS.format("return Layout([[0, 0], [0, 0]])"),
    "maps_are_flat": MAPS.format("import numpy; return Layout(numpy.zeros(5, bool))"),
    "maps_are_floats": MAPS.format("import numpy; return Layout(numpy.full((8, 8), 0.5))"),
    "maps_start_outside": MAPS.format("import numpy; return Layout(numpy.zeros((8, 8), bool), (9, 9), (1, 1))"),
    "maps_start_nowhere": MAPS.format("import numpy; return Layout(numpy.zeros((8, 8), bool), 'a', 'b')"),
    "maps_have_a_text_for_kinds": MAPS.format("return None") + "    kinds: ClassVar = 'grid'\n",
    "maps_have_no_words": MAPS.format("return None") + "    def words(self): raise RuntimeError('wordless')\n",
    "maps_count_badly": MAPS.format("return None") + "    def tasks(self, conditions): return 'many'\n",
    "maps_count_and_raise": MAPS.format("return None") + "    def tasks(self, conditions): raise RuntimeError('no')\n",
    "maps_extend_badly": MAPS.format("import numpy; return Layout(numpy.zeros((8, 8), bool), (0, 0), (7, 7))")
    + "    def extent(self): raise RuntimeError('no\\nend')\n",
}
"""Files that `check` refuses, by their names; those of maps begin with `maps`."""

LIMIT = {"steps": 60, "hard_seconds": 6}

HEALTHY = ["variant", "agent", "episode"]


def play(desk: Any, rude: list[str], agents: dict[str, Any], workers: int = 2) -> Any:
    """Run some rude planners in one variant, a healthy agent after each; the rude one's file is its own."""
    listed: list[Any] = []
    for name in rude:
        _, _, act, parts = RUDE[name]
        listed.append({desk.planner(f"{name}.py", act=act, **parts): {"label": name}})
        listed += [{agent: {**fields, "label": f"{agent} after {name}"}} for agent, fields in agents.items()]
    desk.scenario(agents=listed, budget=LIMIT, episodes=1, reference=f"astar after {rude[0]}")
    ended = desk.fogbench("run", "s.yaml", "--workers", str(workers), seconds=400, noisy=True)
    assert ended.code in (0, 1), ended.err
    return desk.rows()


@pytest.fixture(scope="module")
def plain(desks: Callable[[str], Any]) -> pd.DataFrame:
    """A healthy agent alone."""
    desk = desks("plain")
    desk.scenario(budget=LIMIT, episodes=1)
    assert desk.fogbench("run", "s.yaml").code == 0
    return desk.rows()


@pytest.fixture(scope="module")
def together(desks: Callable[[str], Any]) -> pd.DataFrame | str:
    """The rows of all; where they cannot be had, why not."""
    try:
        return play(desks("together"), list(RUDE), {"astar": {}})
    except (AssertionError, OSError, pytest.fail.Exception) as error:
        return f"{type(error).__name__}: {error}"


def test_rude_planners_play_together(together: pd.DataFrame | str) -> None:
    """A run with all of them ends, with a row for each."""
    assert not isinstance(together, str), together
    assert set(RUDE) <= set(together["agent"])


@pytest.mark.parametrize("name", RUDE)
def test_a_rude_planner_costs_its_own_episode(
    name: str, together: pd.DataFrame | str, plain: pd.DataFrame, desk: Any
) -> None:
    """Its outcome and its reason are those of the table, in one line; who plays after it plays as alone."""
    rows = play(desk, [name], {"astar": {}}, 1) if isinstance(together, str) else together
    own = rows[rows["agent"] == name]
    assert len(own) == 1
    outcome, detail = own["outcome"].item(), own["detail"].item()
    assert outcome in RUDE[name].outcomes, detail
    assert RUDE[name].detail in detail
    assert "\n" not in detail
    assert len(detail) < 500
    healthy = rows[rows["agent"] == f"astar after {name}"].assign(agent="astar").reset_index(drop=True)
    pd.testing.assert_frame_equal(healthy, plain, check_exact=True)


def test_what_is_done_to_torch_reaches_no_network(desks: Callable[[str], Any]) -> None:
    """A network after each planner that changes torch plays as it does alone."""
    network, together, alone = {"vin": {"checkpoint": "vin-grid"}}, desks("torch"), desks("alone")
    listed: list[Any] = []
    for name, act in TORCH.items():
        for suffix, parts in (("", {"act": f"import torch; {act}"}), ("_on_import", {"top": f"import torch; {act}"})):
            planner = together.planner(f"{name}{suffix}.py", **parts)
            listed += [{planner: {"label": name + suffix}}]
            listed += [{"vin": {"checkpoint": "vin-grid", "label": f"vin after {name}{suffix}"}}]
    together.scenario(agents=listed, budget=LIMIT | {"hard_seconds": 60}, episodes=1)
    assert together.fogbench("run", "s.yaml").code == 0
    alone.scenario(agents=[network], budget=LIMIT | {"hard_seconds": 60}, episodes=1)
    assert alone.fogbench("run", "s.yaml").code == 0
    rows, expected = together.rows(), alone.rows()
    for label in rows["agent"]:
        if label.startswith("vin"):
            after = rows[rows["agent"] == label].assign(agent="vin").reset_index(drop=True)
            pd.testing.assert_frame_equal(after, expected, check_exact=True, obj=label)


@pytest.fixture(scope="module")
def refusals(desks: Callable[[str], Any]) -> Any:
    """What `check` says of all that it refuses."""
    desk = desks("refused")
    for name, text in REFUSED.items():
        desk.write(f"{name}.py", text)
        maps = {f"./{name}.py:M": {"size": 8}} if name.startswith("maps") else None
        changes = {"maps": maps} if maps else {"agents": ["astar", f"./{name}.py:A"]}
        desk.scenario(f"{name}.yaml", name=name, **changes)
    try:
        return desk, desk.fogbench("check", *(f"{name}.yaml" for name in REFUSED)).lines
    except (AssertionError, pytest.fail.Exception):
        return desk, []


@pytest.mark.parametrize("name", REFUSED)
def test_a_plug_in_that_cannot_play_is_refused_in_a_line(name: str, refusals: Any) -> None:
    """Exit code 2 and a line for each mistake at its scenario: never a traceback, and never a run that fails."""
    desk, together = refusals
    told = [line for line in together if line.startswith(f"{name}.yaml:")]
    if not told:
        alone = desk.fogbench("check", f"{name}.yaml")
        assert alone.code == 2, alone.out
        told = alone.lines
    assert len(told) == (2 if name == "cannot_be_words" else 1), told  # its start is wrong too
    assert all(line.startswith(f"{name}.yaml:") for line in told)


ALONE = {
    "deletes its file": ("import os; os.remove(__file__)", {0, 2}),
    "edits its file": ("open(__file__, 'a').write('\\n# more')", {0, 2}),
    "deletes the results": ("import shutil; shutil.rmtree('results', ignore_errors=True)", {0, 2}),
    "deletes the folder": ("import os, shutil; shutil.rmtree(os.path.dirname(os.path.abspath(__file__)))", {0, 2}),
    "fills the results": ("open('results/small/episodes/part.parquet', 'w').write('x')", {0, 2}),
    "locks the results": ("import os; os.chmod('results', 0)", {0, 2}),
}
"""What a planner may do to files: the exit codes of the run."""


@pytest.mark.parametrize("name", ALONE)
def test_a_planner_that_changes_files_costs_lines(name: str, desk: Any) -> None:
    """A run whose files go away under it ends as usual or with a line, never with a traceback."""
    act, codes = ALONE[name]
    desk.scenario(agents=["astar", desk.planner("bold.py", act=act)], episodes=2)
    ended = desk.fogbench("run", "s.yaml")
    assert ended.code in codes
    assert bool(ended.lines) == (ended.code == 2)
