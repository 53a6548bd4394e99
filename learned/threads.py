"""PyTorch's own threads for work that is not PyTorch's.

Threads of a second pool would have to be woken while PyTorch's still hold the cores and wait for more, which was
measured to be slower than one thread. The door to OpenMP is `GOMP_parallel`, in GNU's library and its stand-ins.
"""

import ctypes
from collections.abc import Callable
from itertools import pairwise

import torch

_OPENMP = ctypes.CDLL(None)  # all that is loaded for everyone in this process, PyTorch's OpenMP among it
_PARALLEL = getattr(_OPENMP, "GOMP_parallel", None)
_WORK = ctypes.CFUNCTYPE(None, ctypes.c_void_p)


def share(run: Callable[[int, int], None], count: int) -> None:
    """Call `run(first, last)` for ranges that make up `range(count)`, one for each thread that PyTorch has.

    Without an OpenMP library to be found, the ranges come one after the other.

    Raises:
        RuntimeError: a call failed; its error has been printed.
    """
    threads = min(count, torch.get_num_threads())
    bounds = [count * i // threads for i in range(threads + 1)]
    waiting = iter(pairwise(bounds))
    done: list[int] = []

    def work(_: object) -> None:
        for first, last in waiting:
            run(first, last)
            done.append(first)

    if threads == 1 or _PARALLEL is None:
        work(None)
    else:
        _PARALLEL(_WORK(work), None, threads, 0)
    if len(done) < threads:
        raise RuntimeError(f"threads: {threads - len(done)} of {threads} calls failed; see the errors above")
