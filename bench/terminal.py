"""What a command prints reaches any terminal, pipe or file; where it cannot, the command ends without a traceback."""

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import NoReturn, TextIO

from fogbench.bench.reporting.plain import printable
from fogbench.worlds.mistake import Mistake

WRONG, UNHEARD = 2, 141
"""Exit codes: the command or a file was wrong; nobody reads what is printed any more (128 + SIGPIPE)."""


@contextmanager
def printing() -> Iterator[None]:
    """Print `?` for what an encoding lacks; whatever a user can put right ends in lines of text and an exit code."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    try:
        try:
            yield
        finally:
            _flush(sys.stdout)  # as the process ends, nobody could tell that it failed
    except Mistake as mistake:
        _end(WRONG, str(mistake))
    except SystemExit as end:
        if not isinstance(end.__context__, BrokenPipeError):
            raise
        _end(UNHEARD)  # rich and click make it 1, which means that an agent crashed
    except BrokenPipeError:
        _end(UNHEARD)
    except OSError as error:
        place = error.filename or "the disk"
        _end(WRONG, f"{place}: got {error.strerror or error}; expected a place to read and write.")


def _flush(stream: TextIO | None) -> None:
    if stream is not None:  # closed by who started the command
        stream.flush()


def _end(code: int, text: str = "") -> NoReturn:
    """Say why, if anybody listens; what could not be printed until now goes nowhere."""
    try:
        if text and sys.stderr is not None:
            print(printable(text), file=sys.stderr, flush=True)  # noqa: T201
    except OSError:
        _drop(sys.stderr)
    _drop(sys.stdout)
    sys.exit(code)


def _drop(stream: TextIO | None) -> None:
    with suppress(OSError, AttributeError):  # one in memory has no number
        number = stream.fileno()  # type: ignore[union-attr]  # or none
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, number)
        os.close(nowhere)
