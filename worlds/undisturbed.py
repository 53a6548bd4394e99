"""Whatever somebody else's code changes in the process that it runs in: it is put back before anything else runs.

What a library has is kept if it is loaded, or else as soon as it is. To keep one more thing is one more line.
"""

import gc
import locale
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import Any, NamedTuple, TextIO, cast

STREAMS = ("stdin", "stdout", "stderr")

SIGNALS = ("SIGHUP", "SIGINT", "SIGQUIT", "SIGUSR1", "SIGUSR2", "SIGPIPE", "SIGALRM", "SIGTERM", "SIGCHLD", "SIGTSTP")


class Kept(NamedTuple):
    """One thing of a library: a function that reads it, and one that puts back what was read."""

    library: str
    read: Callable[[ModuleType], Any]
    put_back: Callable[[ModuleType, Any], object]


def _pair(library: str, read: str, put_back: str) -> Kept:
    """Two functions of the library."""
    return Kept(library, lambda module: getattr(module, read)(), lambda module, was: getattr(module, put_back)(was))


def _attribute(library: str, name: str) -> Kept:
    """An attribute; of a list or a dictionary the contents too."""
    return Kept(
        library,
        lambda module: ((thing := getattr(module, name)), _contents(thing)),
        lambda module, was: setattr(module, name, _filled(*was)),
    )


def _contents(thing: Any) -> Any:
    if isinstance(thing, dict):
        return dict(dict.items(thing))  # asked itself, that of Matplotlib would choose how to draw
    return list(thing) if isinstance(thing, list) else None


def _filled(thing: Any, contents: Any) -> Any:
    if isinstance(contents, dict):
        dict.clear(thing)
        dict.update(thing, contents)
    elif isinstance(contents, list):
        thing[:] = contents
    return thing


def _handle(_: ModuleType, handlers: dict[str, Any]) -> None:
    for name, handler in handlers.items():
        if handler is not None:  # none of Python's
            signal.signal(getattr(signal, name), handler)


@cache
def _spare(number: int) -> int:
    """Another number for what a standard stream of this process was, when first asked."""
    return os.dup(number)


def _streams(module: ModuleType) -> list[tuple[Any, bool, tuple[int, int] | None]]:
    """The standard streams: each with whether it is closed, and which file stands behind its number."""
    streams = [getattr(module, name) for name in STREAMS]
    return [(stream, getattr(stream, "closed", True), _file(number)) for number, stream in enumerate(streams)]


def _file(number: int) -> tuple[int, int] | None:
    """What identifies an open file, of which a spare number is kept; None if it is closed."""
    with suppress(OSError):
        _spare(number)
        found = os.fstat(number)
        return found.st_dev, found.st_ino
    return None


def _open_streams(module: ModuleType, was: list[tuple[Any, bool, tuple[int, int] | None]]) -> None:
    for number, (name, (stream, closed, file)) in enumerate(zip(STREAMS, was, strict=True)):
        if file and _file(number) != file:
            os.dup2(_spare(number), number)
        setattr(module, name, stream if closed or not stream.closed else _reopened(number, stream))


def _reopened(number: int, stream: TextIO) -> TextIO:
    return cast(TextIO, os.fdopen(number, stream.mode, 1, stream.encoding, stream.errors, closefd=False))


def _set_environment(_: ModuleType, variables: dict[str, str]) -> None:
    for name in set(os.environ) - set(variables):
        del os.environ[name]
    os.environ.update(variables)


KEPT = (
    _pair("os", "getcwd", "chdir"),
    Kept("os", lambda _: dict(os.environ), _set_environment),
    Kept("signal", lambda _: {name: signal.getsignal(getattr(signal, name)) for name in SIGNALS}, _handle),
    Kept("signal", lambda _: signal.getitimer(0), lambda _, was: signal.setitimer(0, *was)),  # 0: the real time
    Kept("locale", lambda _: locale.setlocale(locale.LC_ALL), lambda _, was: locale.setlocale(locale.LC_ALL, was)),
    Kept("gc", lambda _: gc.isenabled(), lambda _, on: gc.enable() if on else gc.disable()),
    *(_attribute("sys", name) for name in ("path", "argv", "excepthook")),
    Kept("sys", _streams, _open_streams),
    _pair("sys", "getrecursionlimit", "setrecursionlimit"),
    _pair("sys", "getswitchinterval", "setswitchinterval"),
    *(_attribute("warnings", name) for name in ("filters", "showwarning")),
    Kept("decimal", lambda decimal: decimal.getcontext().copy(), lambda decimal, was: decimal.setcontext(was)),
    Kept(
        "multiprocessing",
        lambda module: module.get_start_method(allow_none=True),
        lambda module, was: module.set_start_method(was, force=True),
    ),
    _pair("random", "getstate", "setstate"),
    _pair("numpy.random", "get_state", "set_state"),
    Kept("numpy", lambda numpy: numpy.geterr(), lambda numpy, was: numpy.seterr(**was)),
    Kept("numpy", lambda numpy: numpy.get_printoptions(), lambda numpy, was: numpy.set_printoptions(**was)),
    _attribute("numba.core.config", "DISABLE_JIT"),
    _attribute("matplotlib", "rcParams"),
    _pair("torch", "get_rng_state", "set_rng_state"),
    _pair("torch", "get_default_dtype", "set_default_dtype"),
    Kept(
        "torch",
        lambda torch: torch.get_default_device(),
        lambda torch, was: torch.set_default_device(None if was.type == "cpu" else was),
    ),
    _pair("torch", "is_grad_enabled", "set_grad_enabled"),
    _pair("torch", "get_num_threads", "set_num_threads"),
    _pair("torch", "get_deterministic_debug_mode", "set_deterministic_debug_mode"),
    _pair("torch", "get_float32_matmul_precision", "set_float32_matmul_precision"),
)

SEEDS = {"random": "seed", "numpy.random": "seed", "torch": "manual_seed"}
"""What seeds the generator that all of a process share."""


class _Watch(MetaPathFinder):
    """Reads all that is kept, of libraries that are loaded later as soon as they are."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self.was: list[tuple[Kept, Any]] = []
        self.libraries = dict.fromkeys((*(kept.library for kept in KEPT), *SEEDS))

    def meet(self, library: str) -> None:
        """Read what there is of a library, and seed its generator."""
        module = sys.modules.get(library)
        if module is None:
            return
        for kept in KEPT:
            if kept.library == library:
                with suppress(Exception):  # what cannot be read cannot be put back
                    self.was.append((kept, kept.read(module)))
        if library in SEEDS:
            getattr(module, SEEDS[library])(self.seed)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """What the path has, with an eye on the end of its loading."""
        spec = PathFinder.find_spec(fullname, path, target) if fullname in self.libraries else None
        if spec is None or spec.loader is None:
            return None
        load = spec.loader.exec_module

        def exec_module(module: ModuleType) -> None:
            load(module)
            self.meet(fullname)

        vars(spec.loader)["exec_module"] = exec_module
        return spec

    def put_back(self) -> None:
        """Put back all that differs; of what was set last, first."""
        for kept, was in reversed(self.was):
            with suppress(Exception):  # a folder that is gone
                module = sys.modules[kept.library]
                if not _same(kept.read(module), was):
                    kept.put_back(module, was)


def _same(one: Any, other: Any) -> bool:
    try:
        return bool(one == other)
    except Exception:  # noqa: BLE001  arrays, which have no one answer
        return False


@contextmanager
def undisturbed(seed: int) -> Iterator[None]:
    """Run code of somebody else: the generators that it shares with all are seeded, and what it changes is put back.

    Args:
        seed: from 0 to 2**32 - 1.
    """
    watch = _Watch(seed)
    for library in watch.libraries:
        watch.meet(library)
    sys.meta_path.insert(0, watch)
    try:
        yield
    finally:
        with suppress(ValueError):
            sys.meta_path.remove(watch)
        watch.put_back()
