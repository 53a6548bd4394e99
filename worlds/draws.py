"""Draws of a NumPy generator inside kernels: the numbers, and the state afterwards, that its own methods give.

A call from Python costs some microseconds for whatever it draws, which is most of what a small map costs. NumPy hands
the functions of a bit generator to compiled code (its C interface, `bitgen_t`); what is made of their bits is in its
file `distributions.c`.
"""

import ctypes
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types

from fogbench.worlds.kernel import instruction, kernel

NEXT_32 = 2
"""The place of the function for 32 bits in `bitgen_t`, after its state and that for 64."""

_pointer = ctypes.pythonapi.PyCapsule_GetPointer
_pointer.restype, _pointer.argtypes = ctypes.c_void_p, (ctypes.py_object, ctypes.c_char_p)


def luck(rng: np.random.Generator) -> int:
    """What kernels draw from, as long as `rng` lives; no other thread may draw from it meanwhile."""
    return int(_pointer(rng.bit_generator.capsule, b"BitGenerator"))


@kernel
def below(luck: int, end: int) -> int:
    """A whole number from 0 to `end` - 1, as `rng.integers(end)` draws it (Lemire 2019); `end` is 1 to 2^32 - 1."""
    if end == 1:
        return 0  # nothing is drawn
    count, bits = np.uint64(end), np.uint64(32)
    product = np.uint64(_next_32(luck)) * count
    while np.uint64(np.uint32(product)) < ((np.uint64(1) << bits) - count) % count:
        product = np.uint64(_next_32(luck)) * count
    return int(np.int64(product >> bits))


@instruction
def _next_32(_: Any, _luck: Any) -> Any:
    """The next 32 bits."""

    def build(_context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        anything = ir.IntType(8).as_pointer()
        fields = builder.inttoptr(values[0], anything.as_pointer())
        function = builder.load(builder.gep(fields, [ir.Constant(ir.IntType(32), NEXT_32)]))
        kind = ir.FunctionType(ir.IntType(32), [anything])
        return builder.call(builder.bitcast(function, kind.as_pointer()), [builder.load(fields)])

    return types.uint32(types.int64), build
