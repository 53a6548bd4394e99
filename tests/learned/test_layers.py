"""Layers are those of PyTorch, of the shapes that were asked for."""

import torch
from torch import nn

from fogbench.learned.layers import convolution, linear
from fogbench.learned.shapes import Shapes, parts
from fogbench.learned.shapes import convolution as convolution_shapes
from fogbench.learned.shapes import linear as linear_shapes


def told(module: nn.Module) -> Shapes:
    """The shapes of a module's weights, by their names."""
    return {name: tuple(weight.shape) for name, weight in module.state_dict().items()}


def test_weights_have_the_shapes_that_were_said() -> None:
    """Alone or as parts of a module, by their names."""
    assert told(nn.Linear(3, 5)) == linear_shapes(3, 5)
    assert told(nn.Conv2d(2, 6, 3)) == convolution_shapes(2, 6, 3)
    whole = nn.ModuleDict({"first": nn.Conv2d(2, 6, 3), "last": nn.Linear(3, 5)})
    assert told(whole) == parts(first=convolution_shapes(2, 6, 3), last=linear_shapes(3, 5))


def test_fresh_weights_are_those_of_pytorch() -> None:
    """The same draws in the same order, with the shapes turned into arguments."""
    torch.manual_seed(0)
    mine = [
        linear((5, 3)),
        linear((5, 3), bias=False),
        convolution((6, 2, 3, 3)),
        convolution((4, 6, 1, 1), bias=False),
    ]
    torch.manual_seed(0)
    theirs = [
        nn.Linear(3, 5),
        nn.Linear(3, 5, bias=False),
        nn.Conv2d(2, 6, 3, padding=1),
        nn.Conv2d(6, 4, 1, bias=False),
    ]
    for one, other in zip(mine, theirs, strict=True):
        assert repr(one) == repr(other)
        assert all(map(torch.equal, one.parameters(), other.parameters()))
