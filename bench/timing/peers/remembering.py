"""Ten steps of a DNC beside the package `dnc`, on two threads, by the wall clock.

Both have an LSTM of 256, 32 rows of 8 numbers, 4 read heads and 1 write head, and start from a blank memory.
"""

from collections.abc import Callable, Iterator

import dnc
import torch
from torch import nn
from turns import Turns, elapsed, milliseconds

from fogbench.learned.dnc.dnc import DNC
from fogbench.learned.dnc.heads import Heads

THREADS = 2
BATCH, STEPS, INPUTS, HIDDEN, ROWS = 64, 10, 16, 256, 32
HEADS = Heads(reads=4, writes=1, word=8)


def memories() -> Iterator[Turns]:
    """Ours beside theirs: outputs without gradients, and outputs with the gradients of all parameters."""
    torch.set_num_threads(THREADS)
    torch.manual_seed(0)
    ours = DNC(INPUTS, INPUTS, HEADS, rows=ROWS, hidden=HIDDEN)
    theirs = dnc.DNC(INPUTS, HIDDEN, num_hidden_layers=1, nr_cells=ROWS, cell_size=HEADS.word, read_heads=HEADS.reads)
    for way, make in {"forward": forward, "forward and backward": both}.items():
        turns = (elapsed(make(network)) for network in (ours, theirs))
        yield Turns.take(f"DNC, {STEPS} steps of {BATCH}, {way}", "dnc", *turns, milliseconds)


def forward(network: nn.Module) -> Callable[[], object]:
    """Outputs without gradients."""
    sequence = torch.randn(BATCH, STEPS, INPUTS)
    return torch.no_grad()(lambda: network(sequence))


def both(network: nn.Module) -> Callable[[], object]:
    """Outputs, and the gradients of all parameters from a dense one."""
    sequence, down = torch.randn(2, BATCH, STEPS, INPUTS)
    parameters = list(network.parameters())
    return lambda: torch.autograd.grad(network(sequence)[0], parameters, down, allow_unused=True)
