"""Sixteen numbers that a kernel handles as one: `Lanes`, a type for Numba.

Sixteen samples that stand side by side run through the same arithmetic, so a kernel for one sample becomes a kernel for
sixteen when its numbers are lanes. Each operation is one AVX-512 instruction for float32, whatever the sizes of the
loops around it, where loops over rows need long rows to become vector code.

    rows    [any, at least 16] the arrays of such a kernel; row i, or its first sixteen numbers, is one `Lanes`
    x + y    and - * /: where one is a plain number, it takes the type of the other's lanes
"""

import math
import operator
from collections.abc import Callable
from typing import Any, cast

import numpy as np
import torch
from llvmlite import ir
from numba import types
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import intrinsic, lower_builtin, models, register_model

from fogbench.worlds.kernel import fused

LANES = 16
NUMBERS: dict[torch.dtype, Any] = {torch.float32: np.float32, torch.float64: np.float64}
LN2 = math.log(2)
SERIES = tuple(1 / math.factorial(k) for k in range(13, -1, -1))


class Lanes(types.Type):
    """Sixteen numbers of one type."""

    def __init__(self, number: types.Float) -> None:
        """Of a Numba type, float32 or float64."""
        self.number = number
        super().__init__(f"Lanes({number})")


@register_model(Lanes)
class _Vector(models.PrimitiveModel):
    def __init__(self, manager: Any, lanes: Lanes) -> None:
        super().__init__(manager, lanes, ir.VectorType(manager.lookup(lanes.number).get_value_type(), LANES))  # type: ignore[no-untyped-call]  # Numba's


def instruction(compose: Callable[..., Any]) -> Callable[..., Any]:
    """What kernels can call, of a function of Numba types that returns a signature and how its code is built."""
    return cast(Callable[..., Any], intrinsic(compose))


def _address(context: Any, builder: Any, rows: Any, array: Any, kind: Any, index: Any) -> Any:
    """Where row `index` begins, as a pointer to a vector."""
    fields = context.make_array(rows)(context, builder, array)
    pitch = builder.extract_value(fields.strides, 0)
    offset = builder.mul(pitch, context.cast(builder, index, kind, types.intp))
    vector = context.get_value_type(Lanes(rows.dtype))
    start = builder.bitcast(fields.data, ir.IntType(8).as_pointer())
    return builder.bitcast(builder.gep(start, [offset]), vector.as_pointer())


def _spread(context: Any, builder: Any, value: Any, kind: Any, lanes: Lanes) -> Any:
    """A plain number in all lanes; lanes as they are."""
    if isinstance(kind, Lanes):
        return value
    vector = context.get_value_type(lanes)
    number = context.cast(builder, value, kind, lanes.number)
    one = builder.insert_element(ir.Constant(vector, ir.Undefined), number, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))


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
        return _spread(context, builder, values[1], number, lanes)

    return lanes(rows, number), build


@instruction
def until(_: Any, x: Any, limit: Any, within: Any, beyond: Any) -> Any:
    """In each lane `within` where x <= limit, else `beyond`."""
    lanes = next(kind for kind in (x, limit, within, beyond) if isinstance(kind, Lanes))

    def build(context: Any, builder: Any, kinds: Any, values: Any) -> Any:
        x, limit, within, beyond = (
            _spread(context, builder, value, kind, lanes) for value, kind in zip(values, kinds.args, strict=True)
        )
        return builder.select(builder.fcmp_ordered("<=", x, limit), within, beyond)

    return lanes(x, limit, within, beyond), build


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
    """Calls LLVM's function of that name."""

    def build(_context: Any, builder: Any, _kinds: Any, values: Any) -> Any:
        (x,) = values
        number = {"float": "f32", "double": "f64"}[str(x.type.element)]
        kind = ir.FunctionType(x.type, [x.type])
        full_name = f"llvm.{name}.v{LANES}{number}"
        return builder.call(builder.module.globals.get(full_name) or ir.Function(builder.module, kind, full_name), [x])

    return build


def _arithmetic(operation: Any, instruction: str) -> None:
    """Let Numba know + - * or / of lanes with lanes or with plain numbers."""

    class Operation(AbstractTemplate):
        def generic(self, operands: Any, _keywords: Any) -> Any:
            for kind in operands:
                if isinstance(kind, Lanes) and all(isinstance(other, Lanes | types.Number) for other in operands):
                    return kind(*operands)
            return None

    def build(context: Any, builder: Any, kinds: Any, values: Any) -> Any:
        x, y = (_spread(context, builder, *each, kinds.return_type) for each in zip(values, kinds.args, strict=True))
        return getattr(builder, instruction)(x, y, flags=("contract",))

    infer_global(operation)(Operation)  # type: ignore[no-untyped-call]  # Numba's
    for operands in ((Lanes, Lanes), (Lanes, types.Number), (types.Number, Lanes)):
        lower_builtin(operation, *operands)(build)  # type: ignore[no-untyped-call]  # Numba's


for _name in ("add", "sub", "mul", "truediv"):
    for _operation in (getattr(operator, _name), getattr(operator, f"i{_name}")):
        _arithmetic(_operation, "f" + _name.removeprefix("true"))


@fused
def larger(x: Any, y: Any) -> Any:
    """The larger of two; NaN in y counts as larger, NaN in x as smaller."""
    return until(y, x, x, y)


@fused
def decay(x: Any) -> Any:
    """e^-|x|, and e^-87 where that is less.

    e^-|x| = 2^-h * e^r, where h is whole and |r| < 0.35, so that 13 terms of the series of e^r are exact in float64.
    """
    x = until(x, 0, x, 0 - x)
    x = until(x, -87, -87, x)
    halvings = whole(x * (-1 / LN2) + 0.5)
    r = x + halvings * LN2
    power = SERIES[0] + 0 * r
    for factor in SERIES[1:]:
        power = power * r + factor
    return power * halved(halvings)


@fused
def logarithm(x: Any) -> Any:
    """log(1 + x) of x in [0, 1], by 17 terms of the series 2 * (s + s^3 / 3 + ...), s = x / (2 + x)."""
    s = x / (2 + x)
    square = s * s
    total = 1 / 33 + 0 * s
    for term in (1 / 31, 1 / 29, 1 / 27, 1 / 25, 1 / 23, 1 / 21, 1 / 19, 1 / 17, 1 / 15, 1 / 13, 1 / 11, 1 / 9, 1 / 7):
        total = total * square + term
    return 2 * s * (((total * square + 1 / 5) * square + 1 / 3) * square + 1)


@fused
def sigmoid(x: Any) -> Any:
    """1 / (1 + e^-x)."""
    e = decay(x)
    return until(x, 0, e, 1) / (1 + e)


@fused
def tanh(x: Any) -> Any:
    """(e^x - e^-x) / (e^x + e^-x)."""
    e = decay(2 * x)
    size = (1 - e) / (1 + e)
    return until(x, 0, 0 - size, size)


@fused
def softplus(x: Any) -> Any:
    """log(1 + e^x)."""
    return larger(0, x) + logarithm(decay(x))
