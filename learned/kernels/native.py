"""Compiled loops that run in PyTorch's own threads, without Python in them.

A job is a handful of integers in a row: sizes, and addresses of arrays. All threads get the same job, and each takes a
next block of its work until none is left. Threads that come back to Python for each block were measured to cost 20
microseconds, these cost 1; threads of a second pool would have to wait for PyTorch's.
"""

import ctypes
from array import array
from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import torch
from llvmlite import ir
from numba import carray, types  # type: ignore[attr-defined]  # it has both
from torch import Tensor

from fogbench.worlds.kernel import callback, instruction, kernel
from fogbench.worlds.types import Array

NUMBERS: dict[torch.dtype, Any] = {torch.float32: np.float32, torch.float64: np.float64}
"""What kernels call the numbers of tensors."""

_PARALLEL = getattr(ctypes.CDLL(None), "GOMP_parallel", None)  # in GNU's OpenMP library and its stand-ins


def job(*names: str) -> np.dtype[np.void]:
    """The type of a job: first `next`, the first block that nobody took, and `blocks`, how many there are."""
    return np.dtype([(name, np.int64) for name in ("next", "blocks", *names)])


@kernel
def no_room(_number: Any, _job: Any) -> tuple[()]:
    """The room of work that needs none."""
    return ()


class Loop(NamedTuple):
    """Work that is done block by block."""

    work: Callable[..., None]
    """A kernel, `work(number, job, block, *room)`, which does one block; `number` is the type of the arrays."""
    form: np.dtype[np.void]
    """The type of its jobs: sizes, then addresses."""
    room: Callable[..., tuple[Any, ...]] = no_room
    """A kernel, `room(number, job)`, whose arrays a thread has for all its blocks."""

    def run(self, number: torch.dtype, blocks: int, sizes: Iterable[int], tensors: Iterable[Tensor | None]) -> None:
        """Do all blocks of a job.

        Args:
            number: float32 or float64.
            blocks: how many blocks there are.
            sizes: the first numbers of the job.
            tensors: those whose addresses are the others; each is contiguous, and 0 stands for None.
        """
        addresses = [0 if tensor is None else tensor.data_ptr() for tensor in tensors]
        run(compiled(self, NUMBERS[number]), blocks, *sizes, *addresses)


@lru_cache
def compiled(loop: Loop, number: type[np.floating[Any]]) -> int:
    """The address of a loop for a type of numbers."""
    work, form, room = loop

    def blockwise(address: Any) -> None:
        job = carray(address, 1, form)[0]
        own = room(number, job)
        block = take(address)
        while block < job.blocks:
            work(number, job, block, *own)
            block = take(address)

    return callback(blockwise)


def run(loop: int, blocks: int, *numbers: int) -> None:
    """Run a loop on a job, in as many threads as PyTorch has and the job has blocks."""
    threads = min(blocks, torch.get_num_threads())
    job = array("q", (0, blocks, *numbers))  # far quicker to make than one of ctypes
    address = ctypes.c_void_p(job.buffer_info()[0])
    if threads > 1 and _PARALLEL is not None:
        _PARALLEL(ctypes.c_void_p(loop), address, threads, 0)
    else:
        _LOOP(loop)(address)


_LOOP = ctypes.CFUNCTYPE(None, ctypes.c_void_p)


@instruction
def take(_: Any, pointer: Any) -> Any:
    """The next block of the job there, counted on so that no other thread gets it."""

    def build(_context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        counter = builder.bitcast(values[0], ir.IntType(64).as_pointer())
        return builder.atomic_rmw("add", counter, ir.Constant(ir.IntType(64), 1), "monotonic")

    return types.int64(pointer), build


@instruction
def pointer(_: Any, _address: Any) -> Any:
    """The pointer that an integer is, for `numba.carray`."""

    def build(_context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        return builder.inttoptr(values[0], ir.IntType(8).as_pointer())

    return types.voidptr(types.int64), build


@kernel
def vector(number: Any, address: int, size: int) -> Array:
    """The vector [size] at an address."""
    return carray(pointer(address), (size,), number)


@kernel
def matrix(number: Any, address: int, height: int, width: int) -> Array:
    """The matrix [height, width] at an address."""
    return carray(pointer(address), (height, width), number)
