"""Names and shapes of weights, from sizes alone: layers are built by them, and files of weights are held against them.

Importing this imports no torch.
"""

Shape = tuple[int, ...]
"""Of one tensor, as PyTorch has it."""

Shapes = dict[str, Shape]
"""Of all weights of a layer or a network, by the names that PyTorch gives them."""


def linear(inputs: int, outputs: int, *, bias: bool = True) -> Shapes:
    """Those of a linear map."""
    return {"weight": (outputs, inputs), **({"bias": (outputs,)} if bias else {})}


def convolution(inputs: int, outputs: int, side: int = 3) -> Shapes:
    """Those of a convolution with kernels of side x side cells."""
    return {"weight": (outputs, inputs, side, side), "bias": (outputs,)}


def joined(**parts: Shapes) -> Shapes:
    """Those of a network, by those of its named parts."""
    return {f"{part}.{name}": shape for part, shapes in parts.items() for name, shape in shapes.items()}
