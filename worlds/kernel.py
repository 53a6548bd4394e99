"""`@kernel`: a loop compiled by Numba, kept on disk where a place can be written.

Numba's own cache knows a kernel by its own file alone, so that an edit to a callee or to a constant of another file
would go unnoticed; it raises where nothing can be written; and two processes that write at once may mix up its index.
So each compiled form has a file of its own here, in a folder named after all the sources that kernels can come from.
Who makes such a folder removes those beside it that nobody has used for a month; any that is missed is compiled anew.
Of a user's kernel only its own file counts: what it calls in other files of the user is not watched.

How Numba is brought to do this stands in `numba_doors`, and why its version has a ceiling.
"""

import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from hashlib import sha256
from inspect import getfile
from pathlib import Path
from time import time
from typing import Any, ClassVar, TypeVar, cast
from uuid import uuid4

import numba
import numpy as np
from numba.extending import intrinsic

from fogbench.worlds import numba_doors
from fogbench.worlds.streams import digest

F = TypeVar("F", bound=Callable[..., Any])

HERE = Path(__file__).parent

DIGEST = 32
"""Bytes of a digest, which a compiled form stands behind."""

OPTIONS = ("OPT", "BOUNDSCHECK", "LOOP_VECTORIZE", "SLP_VECTORIZE", "DISABLE_INTEL_SVML", "DEBUGINFO_DEFAULT")
"""Settings of Numba that other code comes from."""

MONTH = 30 * 24 * 3600
"""Seconds without use after which compiled kernels are removed."""

numba_doors.widen_vectors()

_CALLBACKS: list[object] = []  # so that their code stays


def kernel(function: F) -> F:
    """Compile `function` on its first call; without any writable place to keep it, anew in each process."""
    return _compile(function)


def fused(function: F) -> F:
    """A `kernel` in which a product and a sum may be rounded as one; NaN, infinity and ties stay what they are."""
    return _compile(function, fastmath={"contract"})


def summing(function: F) -> F:
    """A `fused` kernel that may also add its numbers in any order, for long sums."""
    return _compile(function, fastmath={"contract", "reassoc"})


def instruction(compose: Callable[..., Any]) -> Callable[..., Any]:
    """An instruction that kernels can call, of a function from Numba types to a signature and a builder."""
    return cast(Callable[..., Any], intrinsic(compose))


def callback(loop: Callable[[Any], None]) -> int:
    """The address of a loop of one pointer, compiled for callers outside of Python; the code stays."""
    address, code = numba_doors.callback(loop, _Forms(loop, {}))
    _CALLBACKS.append(code)
    return address


def used() -> Path | None:
    """The folder that this process last read compiled kernels from or wrote them to; None while it has done neither."""
    return _Forms.used


def _compile(function: F, **options: Any) -> F:
    compiled = numba.njit(nogil=True, **options)(function)
    with suppress(OSError):  # what was typed at a prompt has no file, and is not kept
        numba_doors.attach(compiled, _Forms(function, options))
    return cast(F, compiled)


def _sources() -> str:
    files = sorted(file for name in ("worlds", "planners", "learned") for file in HERE.with_name(name).rglob("*.py"))
    return digest(numba.__version__, sys.version, *(file.read_text("utf-8") for file in files))[:16]


def _folders() -> Iterator[Path]:
    """Where compiled kernels may be: the folder that is named for them, or else beside the sources, then at home."""
    sources = _sources()
    named = numba.config.CACHE_DIR  # type: ignore[attr-defined]  # Numba makes it on import
    if named:
        yield Path(named, sources)
        return
    yield HERE / "__pycache__" / sources
    with suppress(RuntimeError):  # a user without a home
        yield Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "fogbench" / sources


FOLDERS = tuple(_folders())


class _Forms:
    """What Numba asks for the compiled forms of one kernel. Trouble with the disk only costs the time to compile."""

    used: ClassVar[Path | None] = None
    """The folder that the forms of any kernel were last read from or written to."""

    def __init__(self, function: Any, options: dict[str, Any]) -> None:
        """Keep the forms of `function` under some options.

        Raises:
            OSError: its file cannot be read.
        """
        self.name = f"{function.__module__}.{function.__qualname__}"[-100:]  # a user's module has the name of its place
        text = Path(getfile(function)).read_text("utf-8")  # a user's file is none of `_sources`
        held = [_identity(cell.cell_contents) for cell in function.__closure__ or ()]
        chosen = [(name, sorted(option)) for name, option in options.items()]
        self.source = digest(text, *function.__code__.co_positions(), *held, *chosen)  # many lambdas have one name
        self.fixed = all(held)
        self.cache_path: Path | None = None

    def load_overload(self, signature: object, context: Any) -> Any:
        """The form of a signature, from the first folder that has it; None if none has."""
        for folder in FOLDERS:
            with suppress(Exception):  # missing, forbidden, or broken
                content = self._file(folder, signature, context.codegen()).read_bytes()
                if sha256(content[DIGEST:]).digest() != content[:DIGEST]:
                    continue  # broken machine code would take the process down
                form = numba_doors.unpacked(content[DIGEST:], context)
                self.cache_path = _Forms.used = folder
                with suppress(OSError):  # not ours
                    os.utime(folder)
                return form
        return None

    def save_overload(self, signature: object, form: Any) -> None:
        """Write the form of a signature into the first folder that takes it, if one does."""
        if not (numba_doors.is_portable(form) and self.fixed):  # it holds what belongs to this process
            return
        for folder in FOLDERS:
            with suppress(Exception):  # forbidden, full, or another Numba than was thought of
                _write(self._file(folder, signature, form.codegen), numba_doors.packed(form))
                self.cache_path = _Forms.used = folder
                return

    def _file(self, folder: Path, signature: object, codegen: Any) -> Path:
        options = [int(getattr(numba.config, option) or 0) for option in OPTIONS]
        words = self.source, signature, numba_doors.processor(codegen), *options
        return folder / f"{self.name}-{digest(*words)[:16]}.nbc"


def _identity(thing: object) -> str:
    """What a loop holds, in words that are the same in all processes; none for what belongs to this one."""
    forms = numba_doors.store_of(thing)
    if isinstance(forms, _Forms):
        return forms.source if forms.fixed else ""
    return repr(thing) if isinstance(thing, type | np.dtype) else ""


def _write(path: Path, content: bytes) -> None:
    """Write a file whole or not at all, whoever else writes it."""
    content = sha256(content).digest() + content
    draft = path.with_name(f"{path.name}.{uuid4().hex}")
    if not path.parent.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        _clear(path.parent.parent)
    try:
        draft.write_bytes(content)
        draft.replace(path)
    except OSError:
        draft.unlink(missing_ok=True)
        raise


def _clear(place: Path) -> None:
    """Remove the folders of compiled kernels that nobody has used for long; whatever else is there stays."""
    for folder in place.iterdir():
        with suppress(OSError):  # not ours, or another process was faster
            if re.fullmatch("[0-9a-f]{16}", folder.name) and time() - folder.stat().st_mtime > MONTH:
                for form in folder.glob("*.nbc*"):
                    form.unlink()
                folder.rmdir()
