"""Code of somebody else leaves the process as it was, and finds its generators seeded."""

import os
import random
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import fogbench
from fogbench.worlds.undisturbed import undisturbed

CHANGES = {
    "the working directory": ("os.getcwd()", "os.chdir('/')"),
    "a new variable": ("'NEW' in os.environ", "os.environ['NEW'] = '1'"),
    "a removed variable": ("os.environ.get('PATH')", "del os.environ['PATH']"),
    "a signal's handler": ("signal.getsignal(signal.SIGTERM)", "signal.signal(signal.SIGTERM, signal.SIG_IGN)"),
    "an alarm": ("signal.getitimer(0)", "signal.alarm(1000)"),
    "the locale": ("locale.setlocale(locale.LC_ALL)", "locale.setlocale(locale.LC_ALL, 'C.UTF-8')"),
    "the collector": ("gc.isenabled()", "gc.disable()"),
    "the path": ("list(sys.path)", "sys.path.insert(0, '/nowhere')"),
    "another path": ("(id(sys.path), list(sys.path))", "sys.path = ['/nowhere']"),
    "the arguments": ("list(sys.argv)", "sys.argv.append('--fast')"),
    "the output": ("sys.stdout", "sys.stdout = open(os.devnull, 'w', closefd=True); keep.append(sys.stdout)"),
    "what tells of errors": ("sys.excepthook", "sys.excepthook = print"),
    "the depth of calls": ("sys.getrecursionlimit()", "sys.setrecursionlimit(9000)"),
    "filters of warnings": ("list(warnings.filters)", "warnings.simplefilter('ignore')"),
    "digits of decimals": ("decimal.getcontext().prec", "decimal.getcontext().prec = 60"),
    "how processes start": (
        "multiprocessing.get_start_method(allow_none=True)",
        "multiprocessing.set_start_method('forkserver', force=True)",
    ),
    "luck": ("random.getstate()", "random.seed(3)"),
    "luck of NumPy": ("np.random.get_state()[1].tobytes()", "np.random.seed(3)"),
    "errors of NumPy": ("np.geterr()", "np.seterr(all='raise')"),
    "digits of NumPy": ("np.get_printoptions()['precision']", "np.set_printoptions(precision=2)"),
}
"""What is read, and what changes it."""


LIBRARIES = ("os", "sys", "signal", "locale", "gc", "warnings", "decimal", "multiprocessing", "random")


@pytest.mark.parametrize("change", CHANGES)
def test_what_is_changed_is_put_back(change: str) -> None:
    """Each was changed meanwhile."""
    names = {name: import_module(name) for name in LIBRARIES} | {"np": np, "keep": []}
    read, code = CHANGES[change]
    before = eval(read, names)
    with undisturbed(0):
        exec(code, names)
        assert eval(read, names) != before
    assert eval(read, names) == before
    for file in names["keep"]:
        file.close()


@pytest.mark.parametrize("seed", [0, 7, 2**32 - 1])
def test_shared_generators_are_seeded(seed: int) -> None:
    """They give the same again, and another seed gives something else."""

    def drawn(seed: int) -> tuple[float, float]:
        with undisturbed(seed):
            return random.random(), float(np.random.random())  # noqa: NPY002  what a planner may use

    assert drawn(seed) == drawn(seed) != drawn(5)


def test_an_error_puts_back_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """And a folder that is gone meanwhile does no harm to the rest."""
    depth, gone = sys.getrecursionlimit(), tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)

    def fail() -> None:
        with undisturbed(0):
            sys.setrecursionlimit(9000)
            gone.rmdir()
            os.chdir("/")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert sys.getrecursionlimit() == depth


RUDE = """
import os, sys
import matplotlib, torch
matplotlib.use("svg")
matplotlib.rcParams["font.size"] = 50
torch.set_default_dtype(torch.float64)
torch.set_default_device("meta")
torch.set_grad_enabled(False)
torch.set_num_threads(3)
torch.use_deterministic_algorithms(True)
LUCK = torch.get_rng_state().sum().item()
"""

STATE = """
import sys
from fogbench.worlds.tables import brought
if "first" in sys.argv:
    import matplotlib, torch
brought("rude")
import matplotlib, torch
print(str(dict.get(matplotlib.rcParams, "backend"))[:7], matplotlib.rcParams["font.size"], torch.get_default_dtype(),
      torch.zeros(1).device, torch.is_grad_enabled(), torch.get_num_threads(),
      torch.are_deterministic_algorithms_enabled(), sys.modules["rude"].LUCK)
"""

PLAIN = STATE.replace('brought("rude")\n', "").replace(', sys.modules["rude"].LUCK', "")


def test_a_library_that_comes_with_a_plug_in_has_its_own_defaults(tmp_path: Path) -> None:
    """Whether torch and Matplotlib were loaded before, or by the plug-in itself."""
    (tmp_path / "rude.py").write_text(RUDE)
    paths = os.pathsep.join((str(Path(fogbench.__file__).parents[1]), str(tmp_path)))
    environment = {**os.environ, "PYTHONPATH": paths, "OMP_NUM_THREADS": "1"}
    first, later, plain = (
        subprocess.check_output([sys.executable, "-c", code, *arguments], env=environment, text=True).split()
        for code, arguments in ((STATE, ["first"]), (STATE, []), (PLAIN, []))
    )
    assert first[:-1] == later[:-1] == plain
    assert first == later
