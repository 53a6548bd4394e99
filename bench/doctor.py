"""What is installed here, what is missing, and how fast this machine is."""

import os
import platform
import sys
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, requires, version
from time import perf_counter

import numpy as np
from packaging.requirements import Requirement
from rich.console import Console
from rich.table import Table
from threadpoolctl import threadpool_info

from planners.astar import search

PROJECT = "fogbench"


def examine() -> None:
    """Print it all."""
    console = Console()
    console.print(_packages())
    console.print(_machine())


def _packages() -> Table:
    table = Table("package", "installed", "needed for", title="Packages")
    for need in map(Requirement, _requirements()):
        extra = str(need.marker).rpartition("extra == ")[2].strip('"') if need.marker else ""
        missing = f'missing: pip install ".\\[{extra}]"' if extra else "missing: pip install ."
        table.add_row(need.name, _version(need.name) or missing, f"the extra {extra}" if extra else "everything")
    return table


def _requirements() -> list[str]:
    try:
        return requires(PROJECT) or []
    except PackageNotFoundError:  # run from a checkout that is not installed
        return []


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
    for pool in threadpool_info():
        table.add_row(f"threads of {pool['internal_api']} (main process)", str(pool["num_threads"]))
    maps = os.environ.get("FOGBENCH_MAPS") or "not set: the scenarios under real/ are skipped"
    table.add_row("FOGBENCH_MAPS", maps)
    table.add_row("A* over an empty 512x512 map", f"{1e3 * _seconds_of_search():.2f} ms")
    table.add_row("a 1024x1024 matrix product", f"{2 * 1.024**3 / _seconds_of_product():.1f} GFLOP/s")
    return table


def _seconds_of_search() -> float:
    """Least time of ten searches from corner to corner."""
    known = np.zeros((512, 512), np.uint8)
    return _least(lambda: search(known, (0, 0), (511, 511)))


def _seconds_of_product() -> float:
    """Least time of ten float32 matrix products."""
    matrix = np.ones((1024, 1024), np.float32)
    return _least(lambda: matrix @ matrix)


def _least(call: Callable[[], object]) -> float:
    call()  # compiles
    seconds = []
    for _ in range(10):
        began = perf_counter()
        call()
        seconds.append(perf_counter() - began)
    return min(seconds)
