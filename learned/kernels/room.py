"""Room for tensors that is used again.

The system gives the memory of a new tensor page by page, which takes longer than to fill it. So memory that no tensor
has any more is kept: of large ones for the next of its size, while that of another size goes back; of smaller ones by
the allocator of the C library, which `keep_freed` tells so where it is glibc's.
"""

import ctypes
from math import prod
from weakref import finalize

import numpy as np
import torch
from torch import Tensor

from fogbench.worlds.types import Array

LARGE = 2**24
"""Bytes from which memory is kept; for less the allocator does."""

KEPT = 2**29
"""Bytes that the allocator may keep; by default it gives back what is free at its end, and asks again a step later."""

_FREE: dict[tuple[int, torch.dtype], list[Array]] = {}


def room(like: Tensor, size: tuple[int, int]) -> Tensor:
    """A tensor of some size, not filled, of the type and on the device of `like`."""
    if not like.is_cpu or prod(size) * like.element_size() < LARGE:
        return like.new_empty(size)
    key = prod(size), like.dtype
    if key not in _FREE:
        _FREE.clear()
    free = _FREE.setdefault(key, [])
    memory = free.pop() if free else np.empty(prod(size) * like.element_size(), np.uint8)
    lent = memory[:]  # lives as long as some tensor has the memory
    finalize(lent, free.append, memory).atexit = False
    return torch.from_numpy(lent).view(like.dtype).view(size)


def keep_freed() -> None:
    """Let the allocator of this process keep the memory of tensors that are gone."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_TRIM_THRESHOLD, KEPT)
        mallopt(_MMAP_THRESHOLD, 2 * LARGE)  # the most that it takes


_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3  # what glibc calls them
