"""What agents print goes through the process of the run: who reads it, or does not, is no matter of theirs.

A pipe that nobody reads any more would raise in the midst of a decision, and a full one would hold it up.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from select import PIPE_BUF, select
from signal import SIG_BLOCK, pthread_sigmask, valid_signals
from threading import Thread

PATIENCE = 1.0
"""Seconds to wait for a reader; then what is printed is dropped until it reads again."""

Prints = tuple["Connection[None, None]", "Connection[None, None]"]
"""Where a worker prints, in place of its standard output and its error output."""


@contextmanager
def relayed() -> Iterator[Prints]:
    """Pipes whose contents are printed here, as long as it lasts and they have some."""
    pipes = [get_context("spawn").Pipe(duplex=False) for _ in range(2)]
    threads = [Thread(target=_carry, args=(here, 1 + k), daemon=True) for k, (here, _) in enumerate(pipes)]
    for thread in threads:
        thread.start()
    try:
        yield pipes[0][1], pipes[1][1]
    finally:
        for _, there in pipes:
            there.close()
        for thread in threads:  # a process that an agent has left behind may hold a pipe
            thread.join(PATIENCE)


def _carry(here: "Connection[None, None]", stream: int) -> None:
    """Print what comes, in pieces that a pipe takes at once."""
    pthread_sigmask(SIG_BLOCK, valid_signals())  # they are for the thread that waits for answers
    patience = PATIENCE
    while text := os.read(here.fileno(), PIPE_BUF):
        with suppress(OSError):  # closed, full, or gone
            ready = select([], [stream], [], patience)[1]
            patience = PATIENCE if ready else 0
            if ready:
                os.write(stream, text)


def print_there(prints: Prints) -> None:
    """Let the standard streams of this process be those pipes; they take every letter."""
    for number, name, pipe in zip((1, 2), ("stdout", "stderr"), prints, strict=True):
        os.dup2(pipe.fileno(), number)
        setattr(sys, name, os.fdopen(number, "w", 1, "utf-8", "backslashreplace", closefd=False))
