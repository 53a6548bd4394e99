"""Sixteen numbers that a kernel handles as one: `Lanes`, a type for Numba.

Sixteen samples that stand side by side run through the same arithmetic, so a kernel for one sample becomes a kernel for
sixteen when its numbers are lanes. Each operation is one AVX-512 instruction for float32, whatever the sizes of the
loops around it, where loops over rows need long rows to become vector code.

Kernels get them by `instructions`, which sees to it that the `operators` are known.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import models, register_model

LANES = 16


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


def spread(context: Any, builder: Any, value: Any, kind: Any, lanes: Lanes) -> Any:
    """A plain number in all lanes; lanes as they are."""
    if isinstance(kind, Lanes):
        return value
    vector = context.get_value_type(lanes)
    number = context.cast(builder, value, kind, lanes.number)
    one = builder.insert_element(ir.Constant(vector, ir.Undefined), number, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))
