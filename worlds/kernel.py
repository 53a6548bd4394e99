"""`@kernel`: a loop compiled by Numba, kept on disk where a place can be written.

Numba's cache knows a kernel by its own file alone, so a kernel calls only kernels of its own file: an edit to a callee
elsewhere would go unnoticed.
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

from numba import njit

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile `function` on its first call; without any writable place for the cache, anew in each process."""
    try:
        return cast(F, njit(cache=True, nogil=True)(function))
    except RuntimeError:  # Numba: "no locator available", nothing is writable
        return cast(F, njit(nogil=True)(function))
