"""What + - * and / mean for lanes; Numba knows it once this file is imported, and `instructions` imports it.

A plain number that is added to lanes takes their type.
"""

import operator
from typing import Any

from numba import types
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import lower_builtin

from fogbench.learned.kernels.lanes import Lanes, spread


def _arithmetic(operation: Any, instruction: str) -> None:
    """Let Numba know + - * or / of lanes with lanes or with plain numbers."""

    class Operation(AbstractTemplate):
        def generic(self, operands: Any, _keywords: Any) -> Any:
            for kind in operands:
                if isinstance(kind, Lanes) and all(isinstance(other, Lanes | types.Number) for other in operands):
                    return kind(*operands)
            return None

    def build(context: Any, builder: Any, kinds: Any, values: Any) -> Any:
        x, y = (spread(context, builder, *each, kinds.return_type) for each in zip(values, kinds.args, strict=True))
        return getattr(builder, instruction)(x, y, flags=("contract",))

    infer_global(operation)(Operation)  # type: ignore[no-untyped-call]  # Numba's
    for operands in ((Lanes, Lanes), (Lanes, types.Number), (types.Number, Lanes)):
        lower_builtin(operation, *operands)(build)  # type: ignore[no-untyped-call]  # Numba's


for _name in ("add", "sub", "mul", "truediv"):
    for _operation in (getattr(operator, _name), getattr(operator, f"i{_name}")):
        _arithmetic(_operation, "f" + _name.removeprefix("true"))
