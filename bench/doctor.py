"""What is installed here, what is missing, and how fast this machine is; all kernels are compiled on the way."""

import os
import platform
import sys
import tomllib
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path
from pkgutil import resolve_name
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from rich.console import Console
from rich.table import Column, Table
from rich.text import Text
from threadpoolctl import threadpool_info

from fogbench.bench.playing.play import play
from fogbench.bench.reading.scenario import read_scenario
from fogbench.learned import LEARNED
from fogbench.planners import PLANNERS, SPEEDS
from fogbench.worlds import KINDS
from fogbench.worlds.kernel import used
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Outcome

PROJECT = "fogbench"

PYPROJECT = Path(__file__).parents[1] / "pyproject.toml"
"""Of a checkout; an installed project has none."""

MASKED = "macn_robot: {checkpoint: none, masked: true, label: masked}"
"""A mask has kernels of its own."""

AGENTS = ", ".join([*PLANNERS, *(f"{name}: {{checkpoint: none}}" for name in LEARNED), MASKED])
"""All that ship with the project."""


class Need(NamedTuple):
    """A package that the project needs."""

    name: str
    found: str
    """Its version here; empty: missing."""
    versions: SpecifierSet
    extra: str
    """That needs it; empty: everything does."""

    @property
    def remedy(self) -> str:
        """What puts it right; empty where nothing is wrong."""
        if self.found and self.versions.contains(self.found, prereleases=True):
            return ""
        told = f"needs {self.name}{self.versions}" if self.found else "missing"
        return f'{told}: pip install ".[{self.extra}]"' if self.extra else f"{told}: pip install ."


def examine() -> None:
    """Print it all, and a verdict.

    Raises:
        Mistake: something that is installed does not work, or what everything needs is missing.
    """
    console, needs = Console(), [_need(Requirement(text)) for text in _requirements()]
    console.print(_packages(needs))
    with console.status("Compiling the kernels, and timing them"):
        crashed = rehearse()
        machine, speeds = _machine(), _speeds()
    console.print(machine)
    console.print(speeds)
    console.print(_verdict(needs, crashed), markup=False, highlight=False, soft_wrap=True)


def _verdict(needs: list[Need], crashed: list[str]) -> str:
    """One line: that everything works, or which extras are missing.

    Raises:
        Mistake: as `examine`.
    """
    broken = [f"{need.name} {need.remedy}" for need in needs if need.remedy and (need.found or not need.extra)]
    if broken or crashed:
        raise Mistake(f"Verdict: broken. {'; '.join([*broken, *crashed])}")
    missing = {need.extra: need.name for need in needs if need.remedy}
    if not missing:
        return "Verdict: everything works."
    ways = ", ".join(f'{package} (pip install ".[{extra}]")' for extra, package in missing.items())
    return f"Verdict: all that is installed works. Missing: {ways}."


def rehearse() -> list[str]:
    """Play an episode of every shipped agent that can play here, so that all its kernels are compiled and kept.

    Returns:
        Which agents crashed, and why.
    """
    crashed = []
    for name, kind in ((name, kind) for name, kind in KINDS.items() if kind.rehearsal):
        text = f"name: rehearsal\nkind: {name}{kind.rehearsal}agents: [{AGENTS}]\nepisodes: 1\n"
        scenario = read_scenario(text, Path(__file__))
        for variant in scenario.variants:
            for entry in variant.agents:
                if not entry.skipped:
                    row = play(scenario, variant, entry, episode=0, workers=1)
                    crashed += [f"{entry.label}: {row.detail}"] if row.outcome == Outcome.CRASHED.name else []
    return crashed


def _packages(needs: list[Need]) -> Table:
    table = Table("package", "installed", "needed for", title="Packages")
    for need in needs:
        told = " ".join(filter(None, (need.found, need.remedy)))
        table.add_row(need.name, Text(told), f"the extra {need.extra}" if need.extra else "everything")
    return table


def _need(need: Requirement) -> Need:
    extra = str(need.marker).rpartition("extra == ")[2].strip('"') if need.marker else ""
    return Need(need.name, _version(need.name), need.specifier, extra)


def _requirements() -> list[str]:
    try:
        return requires(PROJECT) or []
    except PackageNotFoundError:  # run from a checkout that is not installed
        project = tomllib.loads(PYPROJECT.read_text("utf-8"))["project"]
        extras = project["optional-dependencies"].items()
        return [*project["dependencies"], *(f'{need}; extra == "{extra}"' for extra, all_ in extras for need in all_)]


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return ""


def _machine() -> Table:
    table = Table("what", "value", title="Machine")
    table.add_row(PROJECT, _version(PROJECT) or "not installed, run from a checkout")
    table.add_row("Python", f"{platform.python_version()} ({sys.executable})")
    table.add_row("system", f"{platform.system()} {platform.machine()}")
    table.add_row("CPUs at hand", str(len(os.sched_getaffinity(0))))
    for pool in threadpool_info():  # one library may be there twice
        table.add_row(f"threads of {Path(pool['filepath']).name} (main process)", str(pool["num_threads"]))
    maps = os.environ.get("FOGBENCH_MAPS") or "not set: the scenarios under real/ are skipped"
    table.add_row("FOGBENCH_MAPS", maps)
    return table


def _speeds() -> Table:
    table = Table("what", Column("value", overflow="fold"), title="Speed")
    for work, target in SPEEDS.items():
        table.add_row(work, f"{1e3 * _least(resolve_name(target)):.2f} ms")
    table.add_row("a 1024x1024 matrix product", f"{2 * 1.024**3 / _seconds_of_product():.1f} GFLOP/s")
    for part, times in _learned().items():
        table.add_row(part, times)
    table.add_row("kernels", _place_of_kernels())
    return table


def _seconds_of_product() -> float:
    """Least time of ten float32 matrix products."""
    matrix = np.ones((1024, 1024), np.float32)
    return _least(lambda: matrix @ matrix)


def _learned() -> dict[str, str]:
    """Times of those parts of learned policies that have kernels; none without PyTorch."""
    try:
        import torch  # noqa: PLC0415  an extra
    except ModuleNotFoundError:
        return {}
    from fogbench.learned.dnc.dnc import DNC  # noqa: PLC0415  it needs the extra
    from fogbench.learned.dnc.heads import Heads  # noqa: PLC0415  likewise
    from fogbench.learned.value_iteration.value_iteration import ValueIteration  # noqa: PLC0415  likewise

    return {
        "value iteration, 128 maps of 16x16, 20 times": _both_ways(ValueIteration(2, 20), torch.rand(128, 2, 16, 16)),
        "a DNC, 64 samples, 10 steps": _both_ways(DNC(256, 4, Heads()), torch.rand(64, 10, 256)),
    }


def _both_ways(part: Any, inputs: Any) -> str:
    """Least times of ten passes, and of ten with gradients of the first result."""
    both = _least(lambda: part(inputs)[0].sum().backward())
    part.requires_grad_(requires_grad=False)
    forward = _least(lambda: part(inputs))
    return f"{1e3 * forward:.2f} ms, with gradients {1e3 * both:.2f} ms"


def _place_of_kernels() -> str:
    folder = used()
    return f"compiled, kept in {folder}" if folder else "compiled by each process for itself: no place can be written"


def _least(call: Callable[[], object]) -> float:
    call()  # compiles
    seconds = []
    for _ in range(10):
        began = perf_counter()
        call()
        seconds.append(perf_counter() - began)
    return min(seconds)
