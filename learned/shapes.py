"""How large the weights of layers are, by their names: for who must know it before any is drawn."""

Shape = tuple[int, ...]
Shapes = dict[str, Shape]
"""As in the `state_dict` of a module, in its order."""


def linear(inputs: int, outputs: int) -> Shapes:
    """A linear layer has a matrix and a bias."""
    return {"weight": (outputs, inputs), "bias": (outputs,)}


def convolution(channels: int, outputs: int, side: int) -> Shapes:
    """A convolution has a square kernel for each pair of channels, and a bias."""
    return {"weight": (outputs, channels, side, side), "bias": (outputs,)}


def parts(**shapes: Shapes) -> Shapes:
    """A module has the weights of its parts, each with the part's name before its own."""
    return {f"{part}.{name}": shape for part, those in shapes.items() for name, shape in those.items()}
