"""Files: read and written whole, known by their contents, complained about in one line; folders held by one process."""

import errno
import fcntl
import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from stat import S_ISDIR, S_ISREG
from time import time_ns

from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import MapError

SETTLED = 2_000_000_000
"""Nanoseconds after which a change of a file cannot hide behind the one before."""


def contents(path: Path) -> bytes:
    """The contents of a file.

    Raises:
        OSError: it cannot be read, or may have no end.
    """
    mode = path.stat().st_mode
    if not (S_ISREG(mode) or S_ISDIR(mode)):  # who reads a folder is told so
        raise OSError(errno.EINVAL, "A device or a pipe", str(path))
    return path.read_bytes()


def read(path: Path) -> bytes:
    """The contents of a file of a map.

    Raises:
        MapError: it cannot be read.
    """
    try:
        return contents(path)
    except OSError as error:
        raise _unreadable(path, error) from None


def _unreadable(path: Path, error: OSError) -> MapError:
    return MapError(f"{path}: {(error.strerror or str(error)).lower()}; give a file that can be read")


@dataclass(frozen=True)
class Loaded:
    """The contents of a file, known by their digest: equal ones are equal wherever they lie under one name."""

    path: Path
    sha256: str
    contents: bytes = field(compare=False, repr=False)


def load(path: Path) -> Loaded:
    """A file with its digest, read once in a process as long as it stays as it is.

    Raises:
        MapError: it cannot be read.
    """
    try:
        status = path.stat()
    except OSError as error:
        raise _unreadable(path, error) from None
    if abs(time_ns() - status.st_ctime_ns) < SETTLED:  # a second change might leave the time of the first
        return _loaded(path)
    return _kept(path, status.st_ctime_ns, status.st_size, status.st_ino)


def _loaded(path: Path) -> Loaded:
    found = read(path)
    return Loaded(path, sha256(found), found)


@lru_cache(maxsize=32)
def _kept(path: Path, *status: int) -> Loaded:
    del status
    return _loaded(path)


def write(path: Path, contents: bytes | memoryview) -> None:
    """Write a whole file or none: to a dot-name, to the disk, then renamed.

    Raises:
        OSError: it cannot be written; the error has its name.
    """
    draft = path.with_name(f".{path.name}")
    try:
        with draft.open("wb") as file:
            file.write(contents)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(path)
    except OSError as error:
        with suppress(OSError):
            draft.unlink()
        raise OSError(error.errno, error.strerror, str(path)) from None


@contextmanager
def alone(folder: Path, work: str) -> Iterator[None]:
    """Hold a folder, which is made if it is not there; the kernel lets go of it, however this process ends.

    Args:
        folder: `.lock` in it has the number of the process that holds it, or held it last.
        work: what is done there.

    Raises:
        Mistake: another process, or this one, holds it already.
        OSError: it cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / ".lock").open("a+") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            lock.seek(0)
            raise Mistake(
                f"{folder}: got a second {work}; expected the one in process {lock.read()} to end first."
            ) from None
        lock.truncate(0)
        lock.write(str(os.getpid()))
        lock.flush()
        yield


def sha256(contents: bytes) -> str:
    """The digest of a file's contents, as 64 hexadecimal digits."""
    return hashlib.sha256(contents).hexdigest()
