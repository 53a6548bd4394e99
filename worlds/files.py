"""Map files: read whole, known by their contents, and complained about in one line."""

import hashlib
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


def sha256(contents: bytes) -> str:
    """The digest of a file's contents, as 64 hexadecimal digits."""
    return hashlib.sha256(contents).hexdigest()
