"""How cost grows with the rows of a memory, with the batch and with the map, and how near it comes to the memory.

    pytest bench/timing/test_growth.py -s

What a step must move at least: all links are read and written once, forward, and read once more with their gradients
read and written on the way back. Beside it stands the rate at which NumPy copies as many bytes, read and written, in
the same process. Each figure is the fastest of some rounds.
"""

from collections.abc import Callable
from functools import partial
from time import perf_counter

import numpy as np
import pytest
import torch

from fogbench.learned.dnc.access import AccessState, blank
from fogbench.learned.dnc.dnc import DNC
from fogbench.learned.dnc.fast import fast_access
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.value_iteration.fast import fast

THREADS = 1
ROUNDS, STEPS, FLOAT = 7, 4, 4
INPUTS = 16

MEMORIES = {
    "all links": Heads(),
    "the 8 strongest links of a row": Heads(kept=8),
    "no links": Heads(links=False),
}
ROWS = 32, 128, 512, 1024, 2048
BATCHES = 1, 16, 64
MAPS = (16, 512), (32, 128), (64, 32), (128, 8)
"""Side and batch: as many cells in all."""


def fastest(turn: Callable[[], object]) -> float:
    """Seconds of one go, of some in a row."""
    turn()
    return min(_seconds(turn) for _ in range(ROUNDS))


def _seconds(turn: Callable[[], object]) -> float:
    began = perf_counter()
    for _ in range(STEPS):
        turn()
    return (perf_counter() - began) / STEPS


def copied(size: int) -> float:
    """Bytes a second that a copy of `size` bytes reads and writes."""
    source, target = np.ones(size, np.uint8), np.ones(size, np.uint8)
    return 2 * size / fastest(lambda: np.copyto(target, source))


@pytest.mark.parametrize("memory", MEMORIES)
def test_rows(memory: str) -> None:
    """One step of one sample without gradients."""
    heads = MEMORIES[memory]
    print()
    for rows in ROWS:
        dnc = DNC(INPUTS, INPUTS, heads, rows=rows).requires_grad_(False)
        dnc.settle()
        x, state = torch.randn(INPUTS), dnc.blank()
        for _ in range(STEPS):
            _, state = dnc.step(x, state)
        taken = fastest(partial(dnc.step, x, state))
        print(f"{memory}, {rows} rows: {1e3 * taken:.3f} ms{_share(heads, 2 * rows**2 * FLOAT, taken)}")


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("memory", MEMORIES)
def test_batches(memory: str, threads: int) -> None:
    """One step of a batch with 512 rows, forward and backward, in a chain as in training."""
    torch.set_num_threads(threads)
    heads, rows = MEMORIES[memory], 512
    print()
    for batch in BATCHES:
        state = blank(heads, rows, (batch,))
        interfaces = [torch.randn(batch, heads.interface).requires_grad_() for _ in range(STEPS)]

        def chain(state: AccessState[torch.Tensor] = state, interfaces: list[torch.Tensor] = interfaces) -> object:
            found, now = [], state
            for interface in interfaces:
                reads, now = fast_access(heads, interface, now)
                found.append(reads)
            return torch.autograd.grad([reads.sum() for reads in found], interfaces)

        taken = fastest(chain) / STEPS
        told = _share(heads, 5 * batch * rows**2 * FLOAT, taken)
        print(f"{memory}, {rows} rows, a batch of {batch}, threads {threads}: {1e3 * taken:.2f} ms{told}")


def test_maps() -> None:
    """An iteration of value iteration on larger and larger maps, as many cells in all."""
    print()
    for side, batch in MAPS:
        reward, kernels = torch.randn(batch, 4, side, side), 0.2 * torch.randn(4, 5, 3, 3)
        few, many = (fastest(torch.no_grad()(partial(fast, reward, kernels, k))) for k in (20, 60))
        cell = (many - few) / 40 / reward[:, 0].numel()
        print(f"{batch} maps of {side}x{side}: {1e9 * cell:.2f} ns a cell and iteration")


def test_robot() -> None:
    """The memory of the paper's robot: 1024 rows of 512 numbers, 4 read and 16 write heads, an LSTM of 512."""
    dnc = DNC(INPUTS, INPUTS, Heads(4, 16, 512), rows=1024, hidden=512).requires_grad_(False)
    dnc.settle()
    x, state = torch.randn(INPUTS), dnc.blank()
    _, state = dnc.step(x, state)
    print(f"\nthe robot's memory: {1e3 * fastest(lambda: dnc.step(x, state)):.0f} ms a step of one sample")


def _share(heads: Heads, size: int, taken: float) -> str:
    """The rate of what must be moved, beside a copy's; nothing for a memory without a matrix of links."""
    if heads.kept or not heads.links:
        return ""
    rate, copy = size / taken, copied(size // 2)
    return f"; at least {size / 2**20:.1f} MiB moved, {rate / 1e9:.1f} GB/s, {rate / copy:.0%} of a copy's rate"
