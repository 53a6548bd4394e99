"""What a worker process does first: it ties its life to its parent's, before anything heavy is imported."""

import ctypes
import os
import signal
import sys
from multiprocessing import parent_process
from pathlib import Path

PR_SET_PDEATHSIG = 1
"""The number of this request in Linux's `prctl`."""


def begin(text: str, path: Path, workers: int) -> None:
    """Prepare this process; see `fogbench.bench.playing.worker.begin` for the arguments."""
    _die_with_parent()
    from fogbench.bench.playing import worker  # noqa: PLC0415  it takes a second, in which the parent may die

    worker.begin(text, path, workers)


def _die_with_parent() -> None:
    """Have Linux kill this process as soon as the one that started it is gone; elsewhere a closed pipe ends it."""
    parent = parent_process()
    if sys.platform == "linux" and parent is not None:
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent.pid:  # it was gone before the request
            os._exit(1)
