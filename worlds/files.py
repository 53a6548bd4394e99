"""Files: read and written whole, known by their contents, complained about in one line; folders held by one process."""

import fcntl
import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import MapError


def read(path: Path) -> bytes:
    """The contents of a file.

    Raises:
        MapError: it cannot be read.
    """
    try:
        return path.read_bytes()
    except OSError as error:
        raise MapError(f"{path}: got {(error.strerror or str(error)).lower()}; expected a file to read") from None


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
