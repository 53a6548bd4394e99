"""The private doors of Numba, all that `kernel` goes through, and what each must do.

Numba hands its compiled code to no cache but its own. So `kernel` uses names that a new version may change without a
word: then kernels are compiled by each process for itself, or by none. That is why pyproject.toml has a ceiling on the
version of Numba. Who raises it runs tests/worlds/test_kernel.py and tests/learned/kernels/test_native.py, where each of
these doors is used.
"""

import pickle
from collections.abc import Callable
from typing import Any, Protocol

from llvmlite.binding import address_of_symbol
from numba import types
from numba.core import config
from numba.core.ccallback import CFunc
from numba.core.codegen import JITCPUCodegen, get_host_cpu_features
from numba.core.compiler import CompileResult
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target
from numba.core.runtime.nrt import rtsys
from numba.core.serialize import dumps


class Store(Protocol):
    """What Numba asks for the compiled forms of a function: before it compiles one, and after."""

    cache_path: Any
    """Where they are, which Numba repeats in `stats`."""

    def load_overload(self, signature: object, context: Any) -> Any:
        """The form of a signature, or None."""

    def save_overload(self, signature: object, form: Any) -> None:
        """Keep the form of a signature."""


def widen_vectors() -> None:
    """Let loops fill whole registers of 512 bits where the processor has them; LLVM prefers halves on many of Intel's.

    Numba asks for the features of the processor when it compiles for the first time. What a user names is left.
    """
    features: str = get_host_cpu_features()  # type: ignore[no-untyped-call]  # Numba's
    if "+avx512f" in features.split(",") and config.CPU_FEATURES is None:  # type: ignore[attr-defined]  # Numba makes it
        config.CPU_FEATURES = f"{features},-prefer-256-bit"  # type: ignore[attr-defined]  # likewise


def attach(compiled: Any, store: Store) -> None:
    """Let a compiled function ask a store, as `cache=True` lets it ask Numba's own."""
    compiled._cache = store  # noqa: SLF001  it is set by nobody else


def store_of(compiled: object) -> object:
    """The store that a compiled function asks; None for any other thing."""
    return getattr(compiled, "_cache", None)


def callback(loop: Callable[[Any], None], store: Store) -> tuple[int, object]:
    """The address of a loop of one pointer, compiled for callers outside of Python, and what its code stays with.

    LLVM keeps the first of all functions of one name in an engine: a loop would call the kernels that were compiled
    before it where the same loop, read from a store, calls the copies that came with it, which were optimised once more
    and may round otherwise. So the code that runs always comes from the packed form, into an engine for itself.
    """
    with global_compiler_lock:
        signature, context = types.void(types.voidptr), _apart()
        form = store.load_overload(signature, context)
        if form is None:
            fresh = _compiled(loop, signature)
            store.save_overload(signature, fresh)
            form = unpacked(packed(fresh), context)
        return form.library.get_pointer_to_function(form.fndesc.llvm_cfunc_wrapper_name), form


def _apart() -> Any:
    """What forms are unpacked in, with an engine that has no code yet."""
    codegen: Any = JITCPUCodegen
    return cpu_target.target_context.subtarget(_internal_codegen=codegen("fogbench"))


def _compiled(loop: Callable[[Any], None], signature: Any) -> Any:
    """The form of a loop, in the engine of all others. `numba.cfunc` would ask no store before."""
    compiled: Any = CFunc(loop, (signature.args, signature.return_type), {}, {})
    return compiled._compile_uncached()  # noqa: SLF001  `compile` would run it there


def is_portable(form: Any) -> bool:
    """Whether a form holds no address of this process."""
    return not form.library.has_dynamic_globals


def packed(form: Any) -> bytes:
    """A form, with its machine code and the names of what that needs from outside."""
    dump: Any = dumps
    content: bytes = dump((_needs(form), form._reduce()))  # noqa: SLF001  as Numba's own cache does it
    return content


def unpacked(content: bytes, context: Any) -> Any:
    """Undo `packed`; what was not written by it may take the process down.

    Numba's own cache first loads all that compiling needs, for a third of a second in each process. Code that was
    compiled before runs without, unless it needs something by a name that only comes with that.
    """
    needs, parts = pickle.loads(content)  # noqa: S301  `kernel` has written it
    runtime: Any = rtsys
    runtime.initialize(context)
    if not all(map(address_of_symbol, needs)):
        context.refresh()
    rebuild: Any = CompileResult._rebuild  # noqa: SLF001  likewise
    return rebuild(context, *parts)


def _needs(form: Any) -> list[str]:
    """The names of the functions and variables that machine code uses and does not have; LLVM has its own itself."""
    module = form.library._final_module  # noqa: SLF001  `inspect_llvm` prints it
    names = [each.name for each in (*module.functions, *module.global_variables) if each.is_declaration]
    return [name for name in names if not name.startswith("llvm.")]


def processor(codegen: Any) -> object:
    """What machine code was made for, in words that are the same in all processes on one machine."""
    return codegen.magic_tuple()
