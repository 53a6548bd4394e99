"""The instructions on lanes: kernels take them from the rows of arrays, compare them and put them back.

The arrays of such a kernel are [any, at least 16]; row i, or its first sixteen numbers, is one `Lanes`.
"""

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types

from fogbench.learned.kernels import operators  # noqa: F401  whoever has lanes can add them
from fogbench.learned.kernels.lanes import LANES, Lanes, spread
from fogbench.worlds.kernel import instruction


def _address(context: Any, builder: Any, rows: Any, array: Any, kind: Any, index: Any) -> Any:
    """A pointer to the vector that row `index` begins with."""
    fields = context.make_array(rows)(context, builder, array)
    pitch = builder.extract_value(fields.strides, 0)
    offset = builder.mul(pitch, context.cast(builder, index, kind, types.intp))
    vector = context.get_value_type(Lanes(rows.dtype))
    start = builder.bitcast(fields.data, ir.IntType(8).as_pointer())
    return builder.bitcast(builder.gep(start, [offset]), vector.as_pointer())


@instruction
def at(_: Any, rows: Any, index: Any) -> Any:
    """Row `index`."""

    def build(context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        pointer = _address(context, builder, rows, values[0], index, values[1])
        return builder.load(pointer, align=rows.dtype.bitwidth // 8)

    return Lanes(rows.dtype)(rows, index), build


@instruction
def put(_: Any, rows: Any, index: Any, _lanes: Any) -> Any:
    """Make lanes the row `index`."""

    def build(context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        pointer = _address(context, builder, rows, values[0], index, values[1])
        builder.store(values[2], pointer, align=rows.dtype.bitwidth // 8)
        return context.get_dummy_value()

    return types.void(rows, index, Lanes(rows.dtype)), build


@instruction
def full(_: Any, rows: Any, number: Any) -> Any:
    """A number in all lanes, of the type of `rows`."""
    lanes = Lanes(rows.dtype)

    def build(context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        return spread(context, builder, values[1], number, lanes)

    return lanes(rows, number), build


@instruction
def until(_: Any, x: Any, limit: Any, within: Any, beyond: Any) -> Any:
    """In each lane `within` where x <= limit, else `beyond`."""
    lanes = next(kind for kind in (x, limit, within, beyond) if isinstance(kind, Lanes))

    def build(context: Any, builder: Any, kinds: Any, values: Any) -> Any:
        x, limit, within, beyond = (
            spread(context, builder, value, kind, lanes) for value, kind in zip(values, kinds.args, strict=True)
        )
        return builder.select(builder.fcmp_ordered("<=", x, limit), within, beyond)

    return lanes(x, limit, within, beyond), build


@instruction
def total(_: Any, x: Any) -> Any:
    """The sum of all lanes, a plain number."""

    def build(_context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        zero = ir.Constant(values[0].type.element, -0.0)
        return _reduced("fadd", builder, [zero, values[0]], ("reassoc",))

    return x.number(x), build


@instruction
def largest(_: Any, x: Any) -> Any:
    """The largest of all lanes, a plain number; NaN only where all are."""

    def build(_context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        return _reduced("fmax", builder, values, ())

    return x.number(x), build


@instruction
def root(_: Any, x: Any) -> Any:
    """The square root."""
    return x(x), _named("sqrt")


@instruction
def whole(_: Any, x: Any) -> Any:
    """The largest integer that is not larger."""
    return x(x), _named("floor")


@instruction
def halved(_: Any, times: Any) -> Any:
    """2^-times for whole numbers, by the bits of the result."""
    bits, fraction = times.number.bitwidth, {32: 23, 64: 52}[times.number.bitwidth]
    integers = ir.VectorType(ir.IntType(bits), LANES)

    def build(_context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        bias, shift = (ir.Constant(integers, [n] * LANES) for n in ((1 << bits - fraction - 2) - 1, fraction))
        exponent = builder.sub(bias, builder.fptosi(values[0], integers))
        return builder.bitcast(builder.shl(exponent, shift), values[0].type)

    return times(times), build


def _named(name: str) -> Callable[..., Any]:
    """A builder of calls to LLVM's function of that name."""

    def build(_context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        return builder.call(_of_llvm(name, builder.module, values, values[0].type), values)

    return build


def _reduced(name: str, builder: Any, values: Any, flags: tuple[str, ...]) -> Any:
    """A call of LLVM's function that makes one number of all lanes, the last of the values."""
    function = _of_llvm(f"vector.reduce.{name}", builder.module, values, values[-1].type.element)
    return builder.call(function, values, fastmath=flags)


def _of_llvm(name: str, module: Any, values: Any, result: Any) -> Any:
    """LLVM's function of that name, for lanes as the last of the values."""
    number = {"float": "f32", "double": "f64"}[str(values[-1].type.element)]
    full_name = f"llvm.{name}.v{LANES}{number}"
    kind = ir.FunctionType(result, [value.type for value in values])
    return module.globals.get(full_name) or ir.Function(module, kind, full_name)
