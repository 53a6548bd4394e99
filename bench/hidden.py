"""Libraries that a file of the user's stands in front of, because a folder on the path has one of the same name.

It imports nothing that could be hidden itself, as far as that can be.
"""

import sys
import sysconfig
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import NoReturn

LIBRARIES = (
    "numpy", "numba", "yaml", "pydantic", "pandas", "pyarrow", "scipy", "matplotlib", "networkx", "rich", "typer",
    "pebble", "packaging", "torch", "safetensors", "sklearn", "ompl",
)  # fmt: skip
"""Packages that the project imports; none of them is a single file."""


def refuse_hidden_libraries() -> None:
    """End the command in one line if a file hides one of the libraries; none of them is imported."""
    for name in LIBRARIES:
        try:
            spec = find_spec(name)
        except ValueError:  # somebody has put something else in its place
            continue
        if spec is not None and spec.submodule_search_locations is None and spec.origin:
            _end(spec.origin, name)


@contextmanager
def blaming_hidden() -> Iterator[None]:
    """What cannot be imported meanwhile ends the command in one line, if a file hides a module of Python itself."""
    try:
        yield
    except (ImportError, AttributeError):
        own = {Path(sysconfig.get_path(part)) for part in ("stdlib", "platstdlib", "purelib", "platlib")}
        for name in sorted(sys.stdlib_module_names & sys.modules.keys()):
            place = getattr(sys.modules[name], "__file__", None)
            if place and not own & set(Path(place).parents):
                _end(place, name)
        raise


def _end(place: str, name: str) -> NoReturn:
    told = f"got a file that hides the library {name}; rename it, or take its folder off PYTHONPATH."
    sys.stderr.write(f"{place}: {told}\n")
    sys.exit(2)
