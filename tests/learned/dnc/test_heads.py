"""The sizes of a DNC are known before it is made, and without PyTorch."""

import subprocess
import sys

import pytest
import torch

from fogbench.learned.dnc.access import blank
from fogbench.learned.dnc.controller import Controller
from fogbench.learned.dnc.dnc import DNC
from fogbench.learned.dnc.heads import Heads, controller_shapes, shapes

HEADS = [Heads(), Heads(2, 3, 5), Heads(2, 3, 5, links=False), Heads(1, 1, 1), Heads(2, 3, 5, kept=4)]


@pytest.mark.parametrize("heads", HEADS)
def test_weights_have_the_shapes_that_were_said(heads: Heads) -> None:
    """Names, order and shapes are those of a network's state."""
    network = DNC(7, 3, heads, hidden=9)
    assert list(shapes(7, 3, heads, 9).items()) == [(name, tuple(w.shape)) for name, w in network.state_dict().items()]
    controller = Controller(7, 9).state_dict()
    assert list(controller_shapes(7, 9).items()) == [(name, tuple(w.shape)) for name, w in controller.items()]


@pytest.mark.parametrize("heads", HEADS)
def test_a_blank_state_has_the_shapes_that_were_said(heads: Heads) -> None:
    """Each part, with a batch before it."""
    assert [part.shape[1:] for part in blank(heads, 6, (2,))] == [torch.Size(part) for part in heads.state_shapes(6)]


def test_the_paper_s_interface() -> None:
    """79 numbers for 4 read and 1 write heads, 40 for 1 and 1, 127 for 1 and 4, 26,812 for the robot's 4 and 16."""
    sizes = [Heads(4, 1, 8), Heads(1, 1, 8), Heads(1, 4, 8), Heads(4, 16, 512)]
    assert [heads.interface for heads in sizes] == [79, 40, 127, 26_812]


@pytest.mark.parametrize("module", ["dnc.heads", "value_iteration.sizes", "convolution.sizes"])
def test_sizes_need_no_pytorch(module: str) -> None:
    """Who only asks how large weights are does not load it."""
    script = f"import sys, fogbench.learned.{module}; assert 'torch' not in sys.modules"
    subprocess.run([sys.executable, "-c", script], check=True)
