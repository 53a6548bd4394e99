"""The memory access of a DNC and a whole DNC, fast beside plain, on two threads.

    pytest bench/timing/test_dnc.py -s

A batch of 64 and the paper's sizes: 32 rows of 8 numbers, 4 read heads and 1 write head, an LSTM of 256. In each round
all take their turn, so that what else the machine does falls on all; the ratios are medians over rounds. Gradients by
everything come in as they lie in a chain of steps, for each form in its own way.
"""

from collections.abc import Callable
from time import perf_counter

import numpy as np
import pytest
import torch
from pytest_benchmark.fixture import BenchmarkFixture
from torch import Tensor, nn

from fogbench.learned.dnc.access import AccessState, access, blank, controls
from fogbench.learned.dnc.dnc import DNC
from fogbench.learned.dnc.fast import fast_access
from fogbench.learned.dnc.heads import Heads
from fogbench.worlds.types import Array

THREADS = 2
ROUNDS, STEPS = 30, 10
BATCH, ROWS, INPUTS = 64, 32, 16
HEADS = Heads(reads=4, writes=1, word=8)

Form = Callable[[Heads, Tensor, AccessState[Tensor]], tuple[Tensor, AccessState[Tensor]]]
Turn = Callable[[], object]


def plain_access(heads: Heads, interface: Tensor, state: AccessState[Tensor]) -> tuple[Tensor, AccessState[Tensor]]:
    """The equations, called as the fast form."""
    return access(controls(heads, interface), state)


FORMS: dict[str, Form] = {"plain": plain_access, "fast": fast_access}


def after_steps(form: Form) -> AccessState[Tensor]:
    """A state after some steps, as the form leaves it."""
    torch.manual_seed(0)
    state = blank(HEADS, ROWS, (BATCH,))
    with torch.no_grad():
        for _ in range(STEPS):
            _, state = form(HEADS, torch.randn(BATCH, HEADS.interface), state)
    return state


def access_forward(name: str) -> Turn:
    """One step without gradients."""
    form, state, interface = FORMS[name], after_steps(FORMS[name]), torch.randn(BATCH, HEADS.interface)
    return torch.no_grad()(lambda: form(HEADS, interface, state))


def access_both(name: str) -> Turn:
    """One step, and the gradients by everything from everything."""
    form, state = FORMS[name], after_steps(FORMS[name])
    down = [torch.randn(BATCH, HEADS.reads, HEADS.word), *after_steps(form)]
    inputs = [torch.randn(BATCH, HEADS.interface).requires_grad_(), *(part.requires_grad_() for part in state)]

    def turn() -> object:
        reads, after = form(HEADS, inputs[0], AccessState(*inputs[1:]))
        return torch.autograd.grad([reads, *after], inputs, down, allow_unused=True)

    return turn


def chain_both(name: str) -> Turn:
    """Ten steps in a row as in training, and the gradients by all interfaces and the first state from all reads."""
    form, state, reads = FORMS[name], after_steps(FORMS[name]), (BATCH, HEADS.reads, HEADS.word)
    interfaces = [torch.randn(BATCH, HEADS.interface).requires_grad_() for _ in range(STEPS)]
    inputs, down = [*interfaces, *(part.requires_grad_() for part in state)], [torch.randn(reads) for _ in range(STEPS)]

    def turn() -> object:
        found, now = [], AccessState(*inputs[STEPS:])
        for interface in interfaces:
            reads, now = form(HEADS, interface, now)
            found.append(reads)
        return torch.autograd.grad(found, inputs, down, allow_unused=True)

    return turn


def network(name: str) -> DNC:
    """A whole DNC."""
    return DNC(INPUTS, INPUTS, HEADS, rows=ROWS, fast=name == "fast")


def network_forward(network: nn.Module) -> Turn:
    """Ten steps without gradients."""
    sequence = torch.randn(BATCH, STEPS, INPUTS)
    return torch.no_grad()(lambda: network(sequence))


def network_both(network: nn.Module) -> Turn:
    """Ten steps, and the gradients by all weights from all outputs."""
    sequence, weights, down = (
        torch.randn(BATCH, STEPS, INPUTS),
        list(network.parameters()),
        torch.randn(BATCH, STEPS, INPUTS),
    )
    return lambda: torch.autograd.grad(network(sequence)[0], weights, down, allow_unused=True)


def single(name: str) -> Turn:
    """One step of a single sample without gradients."""
    one = network(name)
    one.settle()
    x, state = torch.randn(INPUTS), one.blank()
    with torch.no_grad():
        _, state = one.step(x, state)
    return torch.no_grad()(lambda: one.step(x, state))


WORK: dict[str, Callable[[str], Turn]] = {
    "memory access, forward": access_forward,
    "memory access, forward and backward": access_both,
    f"memory access, {STEPS} steps, forward and backward": chain_both,
    f"DNC, {STEPS} steps, forward": lambda name: network_forward(network(name)),
    f"DNC, {STEPS} steps, forward and backward": lambda name: network_both(network(name)),
    "DNC, one step of one sample": single,
}


@pytest.mark.parametrize("work", WORK)
@pytest.mark.parametrize("name", FORMS)
def test_form(benchmark: BenchmarkFixture, name: str, work: str) -> None:
    """Each form by itself."""
    benchmark.group = work
    turn = WORK[work](name)
    turn()  # compiles the loops
    benchmark(turn)


@pytest.mark.parametrize("work", WORK)
def test_ratio(work: str) -> None:
    """How many times as fast as the plain form, taking turns."""
    plain, fast = (WORK[work](name) for name in FORMS)
    times = taking_turns([plain, fast])
    before, after = 1e6 * np.median(times, 0)
    ratio = np.median(times[:, 0] / times[:, 1])
    print(f"\n{work}: plain {before:.0f} us, fast {after:.0f} us, {ratio:.1f} times as fast")


def taking_turns(turns: list[Turn]) -> Array:
    """[rounds, turns] the seconds of one go of each, after two rounds that do not count."""
    return np.array([[seconds(turn) for turn in turns] for _ in range(ROUNDS + 2)])[2:]


def seconds(turn: Turn) -> float:
    """Seconds of one go; there are ten in a row, as in a chain of steps, where a step finds its arrays in the cache."""
    began = perf_counter()
    for _ in range(STEPS):
        turn()
    return (perf_counter() - began) / STEPS
