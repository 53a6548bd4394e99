"""Files: read whole and written whole, known by their contents, and complained about in one line."""

import hashlib
import os
from pathlib import Path

from worlds.types import MapError


def read(path: Path) -> bytes:
    """The contents of a file.

    Raises:
        MapError: it cannot be read.
    """
    try:
        return path.read_bytes()
    except OSError as error:
        raise MapError(f"{path}: got {(error.strerror or str(error)).lower()}; expected a file to read") from None


def put(path: Path, contents: bytes | memoryview) -> None:
    """Write a whole file or none: to a dot-name, to the disk, then renamed.

    Raises:
        OSError: it cannot be written.
    """
    draft = path.with_name(f".{path.name}")
    with draft.open("wb") as file:
        file.write(contents)
        file.flush()
        os.fsync(file.fileno())
    draft.replace(path)


def sha256(contents: bytes) -> str:
    """The digest of a file's contents, as 64 hexadecimal digits."""
    return hashlib.sha256(contents).hexdigest()
