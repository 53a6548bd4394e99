"""`@kernel`: a loop compiled by Numba, kept on disk where a place can be written.

Numba knows a cached kernel by its own file alone; an edit to a callee or to a constant of another file would go
unnoticed. So the folder of the cache is named after all the sources that kernels can come from.
"""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import config, njit

from worlds.streams import digest

F = TypeVar("F", bound=Callable[..., Any])

HERE = Path(__file__).parent


def _sources() -> str:
    files = sorted(file for name in ("worlds", "planners", "learned") for file in HERE.with_name(name).glob("*.py"))
    return digest(*(file.read_text("utf-8") for file in files))[:16]


if "NUMBA_CACHE_DIR" not in os.environ:
    config.CACHE_DIR = str(HERE / "__pycache__" / _sources())  # type: ignore[attr-defined]  # Numba makes it on import


def kernel(function: F) -> F:
    """Compile `function` on its first call; without any writable place for the cache, anew in each process."""
    return _compile(function)


def fused(function: F) -> F:
    """A `kernel` in which a product and a sum may be rounded as one; NaN, infinity and ties stay what they are."""
    return _compile(function, fastmath={"contract"})


def summing(function: F) -> F:
    """A `fused` kernel that may also add its numbers in any order, for long sums."""
    return _compile(function, fastmath={"contract", "reassoc"})


def _compile(function: F, **options: Any) -> F:
    try:
        return cast(F, njit(cache=True, nogil=True, **options)(function))
    except RuntimeError:  # Numba: "no locator available", nothing is writable
        return cast(F, njit(nogil=True, **options)(function))
