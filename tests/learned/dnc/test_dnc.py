"""The DNC does what its equations say, fused or not, whatever the number of heads, rows and steps."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from unittest.mock import patch

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from torch import Tensor

from fogbench.learned.dnc.access import AccessState, access, allocation, blank, controls, spread
from fogbench.learned.dnc.dnc import DNC
from fogbench.learned.dnc.fast import fast_access
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.dnc.layout import MANY
from fogbench.worlds.types import Array

COUNTS = [1, 2, 4]


def plain(heads: Heads, interface: Tensor, state: AccessState[Tensor]) -> tuple[Tensor, AccessState[Tensor]]:
    """The plain form, called as the fast one."""
    return access(controls(heads, interface), state, heads.strongest(state.usage.shape[-1]))


def many(heads: Heads, interface: Tensor, state: AccessState[Tensor]) -> tuple[Tensor, AccessState[Tensor]]:
    """The fast form, with rows side by side."""
    with rows_side_by_side(True):
        return fast_access(heads, interface, state)


Form = Callable[[Heads, Tensor, AccessState[Tensor]], tuple[Tensor, AccessState[Tensor]]]
FORMS = pytest.mark.parametrize("form", [plain, fast_access, many])


@contextmanager
def threads_of_torch(threads: int) -> Iterator[None]:
    """As many threads of PyTorch for a while."""
    before = torch.get_num_threads()
    torch.set_num_threads(threads)
    yield
    torch.set_num_threads(before)


@contextmanager
def rows_side_by_side(many: bool) -> Iterator[None]:
    """Take all numbers of rows for many, or for few."""
    with patch.dict(MANY, dict.fromkeys(MANY, 1 if many else 1000)):
        yield


class Loop:
    """The equations as loops over heads and rows, one sample, in float64."""

    def __init__(self, heads: Heads, rows: int) -> None:
        """All zeros."""
        self.heads, self.rows = heads, rows
        self.memory = np.zeros((rows, heads.word))
        self.read, self.write = np.zeros((heads.reads, rows)), np.zeros((heads.writes, rows))
        self.usage = np.zeros(rows)
        self.links, self.precedence = np.zeros((heads.linked, rows, rows)), np.zeros((heads.linked, rows))

    def step(self, interface: Array) -> Array:
        """What is read [R, D]."""
        word, rows, linked = self.heads.word, self.rows, self.heads.linked
        numbers = iter(interface)

        def take(count: int) -> Array:
            return np.array([next(numbers) for _ in range(count)])

        writers = [
            (take(word), softplus(take(1)), take(word), sigmoid(take(word)), sigmoid(take(1)), sigmoid(take(1)))
            for _ in range(self.heads.writes)
        ]
        readers = [
            (take(word), softplus(take(1)), sigmoid(take(1)), softmax(take(2 * linked + 1)))
            for _ in range(self.heads.reads)
        ]
        for n in range(rows):
            written = 1 - np.prod([1 - w[n] for w in self.write])
            kept = np.prod([1 - free * w[n] for (_, _, free, _), w in zip(readers, self.read, strict=True)])
            self.usage[n] = (self.usage[n] + (1 - self.usage[n]) * written) * kept
        used, weights = self.usage.copy(), []
        for key, strength, _, _, allocate, gate in writers:
            free = allocated(used)
            used = used + (1 - used) * allocate * gate * free
            weights.append(gate * (allocate * free + (1 - allocate) * similar(key, strength, self.memory)))
        self.write = np.array(weights)
        memory = self.memory.copy()
        for (_, _, _, erase, _, _), w in zip(writers, self.write, strict=True):
            memory *= 1 - np.outer(w, erase)
        for (_, _, value, _, _, _), w in zip(writers, self.write, strict=True):
            memory += np.outer(w, value)
        self.memory = memory
        for i in range(linked):
            w = self.write[i]
            for n in range(rows):
                for m in range(rows):
                    link = (1 - w[n] - w[m]) * self.links[i, n, m] + w[n] * self.precedence[i, m]
                    self.links[i, n, m] = 0 if n == m else link
                if self.heads.kept:
                    weak = np.argsort(-self.links[i, n], kind="stable")[self.heads.kept :]
                    self.links[i, n, weak] = 0
            self.precedence[i] = (1 - w.sum()) * self.precedence[i] + w
        for j, (key, strength, _, modes) in enumerate(readers):
            before = self.read[j].copy()
            self.read[j] = modes[-1] * similar(key, strength, memory)
            for i in range(linked):
                self.read[j] += modes[i] * self.links[i].T @ before + modes[linked + i] * self.links[i] @ before
        return self.read @ memory


def softplus(x: Array) -> Array:
    """log(1 + e^x)."""
    return np.log1p(np.exp(x))


def sigmoid(x: Array) -> Array:
    """1 / (1 + e^-x)."""
    return 1 / (1 + np.exp(-x))


def softmax(x: Array) -> Array:
    """A distribution."""
    return np.exp(x) / np.exp(x).sum()


def similar(key: Array, strength: Array, memory: Array) -> Array:
    """The weighting by cosine similarity of a key and the rows of a memory [N, D]."""
    norms = [np.sqrt(key @ key + 1e-6) * np.sqrt(row @ row + 1e-6) + 1e-6 for row in memory]
    return softmax(np.array([strength[0] * (key @ row) / norm for row, norm in zip(memory, norms, strict=True)]))


def allocated(usage: Array) -> Array:
    """The weighting that prefers the rows least used."""
    used, product, weights = 1e-6 + (1 - 1e-6) * usage, 1.0, np.zeros(len(usage))
    for n in sorted(range(len(used)), key=lambda n: used[n]):
        weights[n] = (1 - used[n]) * product
        product *= used[n]
    return weights


def draw(generator: torch.Generator, *shape: int, scale: float = 2.0, dtype: torch.dtype = torch.float64) -> Tensor:
    """Normal numbers."""
    return scale * torch.randn(*shape, generator=generator, dtype=dtype)


def used(heads: Heads, rows: int, batch: int, generator: torch.Generator) -> AccessState[Tensor]:
    """A state with memory and usage drawn.

    From zeros, rows stay alike but for rounding, which then decides in which of them a form writes.
    """
    state = blank(heads, rows, (batch,), torch.zeros((), dtype=torch.float64))
    usage = torch.rand(batch, rows, generator=generator, dtype=torch.float64)
    return state._replace(memory=draw(generator, batch, heads.word, rows), usage=usage)


@FORMS
@pytest.mark.parametrize(("links", "kept"), [(True, 0), (False, 0), (True, 1), (True, 3), (True, 20)])
@pytest.mark.parametrize("writes", COUNTS)
@pytest.mark.parametrize("reads", COUNTS)
def test_fifty_steps_are_those_of_the_equations(form: Form, reads: int, writes: int, links: bool, kept: int) -> None:
    """Both forms agree with loops over heads and rows in what is read and in the state, to 1e-5."""
    generator = torch.Generator().manual_seed(0)
    heads = Heads(reads, writes, 5, links, kept)
    loop, state = Loop(heads, 9), used(heads, 9, 2, generator)
    loop.memory, loop.usage = state.memory[1].T.numpy(), state.usage[1].numpy().copy()
    for _ in range(50):
        interface = draw(generator, 2, heads.interface)
        read, state = form(heads, interface, state)
        expected = loop.step(interface[1].numpy())
        np.testing.assert_allclose(read[1], expected, atol=1e-5)
    np.testing.assert_allclose(state.memory[1].T, loop.memory, atol=1e-5)
    np.testing.assert_allclose(state.read_weights[1], loop.read, atol=1e-5)
    np.testing.assert_allclose(state.write_weights[1], loop.write, atol=1e-5)
    np.testing.assert_allclose(state.usage[1], loop.usage, atol=1e-5)
    all_links = spread(state.links) if kept else state.links
    np.testing.assert_allclose(all_links[1], loop.links, atol=1e-5)
    np.testing.assert_allclose(state.precedence[1], loop.precedence, atol=1e-5)


def gradients(
    form: Form, heads: Heads, interfaces: list[Tensor], start: list[Tensor], seed: int, *, dense: bool
) -> list[Tensor | None]:
    """Those of a random function of all reads and, if dense, of the last state."""
    generator = torch.Generator().manual_seed(seed)
    state, loss = AccessState(*start), torch.zeros((), dtype=interfaces[0].dtype)
    for interface in interfaces:
        read, state = form(heads, interface, state)
        loss = loss + (read * draw(generator, *read.shape)).sum()
    if dense:
        loss = loss + sum((part * draw(generator, *part.shape)).sum() for part in state)
    return list(torch.autograd.grad(loss, [*interfaces, *start], allow_unused=True))


@settings(max_examples=40)
@given(
    wide=st.booleans(),
    batch=st.sampled_from([1, 3, 16, 17, 40]),
    reads=st.integers(1, 4),
    writes=st.integers(1, 4),
    word=st.integers(1, 5),
    links=st.booleans(),
    kept=st.sampled_from([0, 0, 1, 2, 5, 30]),
    rows=st.integers(2, 18),
    every=st.integers(1, 4),
    threads=st.sampled_from([1, 2]),
    dense=st.booleans(),
    seed=st.integers(0, 999),
)
def test_gradients_are_those_of_the_plain_form(
    wide: bool, batch: int, reads: int, writes: int, word: int, links: bool, kept: int, rows: int, every: int,
    threads: int, dense: bool, seed: int,
) -> None:  # fmt: skip
    """Through five steps, by every input and part of the first state, to 1e-5 in norm.

    Whatever lies side by side, links kept or linked again, all of them or the strongest.
    """
    generator = torch.Generator().manual_seed(seed)
    heads = Heads(reads, writes, word, links, kept)
    _, state = plain(heads, draw(generator, batch, heads.interface), used(heads, rows, batch, generator))
    start = [part.requires_grad_() for part in state]
    interfaces = [draw(generator, batch, heads.interface).requires_grad_() for _ in range(5)]
    expected = gradients(plain, heads, interfaces, start, seed, dense=dense)
    with threads_of_torch(threads), rows_side_by_side(wide):
        fast = gradients(lambda *step: fast_access(*step, every), heads, interfaces, start, seed, dense=dense)
    for mine, theirs in zip(fast, expected, strict=True):
        wanted = torch.zeros_like(mine) if theirs is None else theirs  # past write weightings have no gradient
        assert (mine - wanted).norm() <= 1e-5 * wanted.norm()


@pytest.mark.parametrize("form", [fast_access, many])
def test_batches_single_samples_and_threads_agree_to_the_bit(form: Form) -> None:
    """Each sample of a batch gets the bits that it gets alone, on one thread and on two."""
    generator = torch.Generator().manual_seed(0)
    heads = Heads(2, 2, 5)
    start = used(heads, 9, 40, generator)
    interface = draw(generator, 40, heads.interface)
    results = []
    for threads in (1, 2):
        with threads_of_torch(threads):
            reads, state = form(heads, interface, start)
            results.append((reads, *form(heads, interface, state)[1]))
    alone = form(heads, interface[21], AccessState(*(part[21] for part in start)))[1]
    _, alone = form(heads, interface[21], alone)
    for one, two, single in zip(results[0][1:], results[1][1:], alone, strict=True):
        assert torch.equal(one, two)
        assert torch.equal(one[21], single)
    assert torch.equal(results[0][0], results[1][0])


@pytest.mark.parametrize("form", [fast_access, many])
def test_states_may_lie_in_any_way(form: Form) -> None:
    """A state laid out by rows, transposed, or every other sample of a larger one gives the same."""
    generator = torch.Generator().manual_seed(0)
    heads = Heads(2, 2, 5)
    start = used(heads, 9, 6, generator)
    interface = draw(generator, 6, heads.interface)
    _, wanted = form(heads, interface, start)
    transposed = AccessState(*(part.mT.contiguous().mT if part.dim() > 1 else part for part in start))
    spread = AccessState(*(torch.stack([part, part], 1).flatten(0, 1)[::2] for part in start))
    inside = AccessState(*(part[::2] for part in form(heads, interface, start)[1]))
    for state in (transposed, spread):
        _, after = form(heads, interface, state)
        assert all(map(torch.equal, after, wanted))
    _, halves = form(heads, interface[::2], inside)
    _, whole = form(heads, interface, wanted)
    assert all(map(torch.equal, halves, (part[::2] for part in whole)))


def test_links_are_kept_as_rarely_as_asked() -> None:
    """With `every` 3, two steps out of three keep no links, and the backward pass leaves none behind."""
    heads = Heads()
    state = blank(heads, 6, (2,))
    nodes = []
    for _ in range(7):
        interface = torch.randn(2, heads.interface, requires_grad=True)
        reads, state = fast_access(heads, interface, state, 3)
        nodes.append(reads.grad_fn)
    kept = [node.links is not None for node in nodes]
    assert kept == [True, False, False, True, False, False, True]
    reads.sum().backward()
    assert [node.links is not None for node in nodes] == kept


@FORMS
def test_the_first_step_is_that_of_the_equations(form: Form) -> None:
    """From zeros, where all rows are alike, two heads are allocated the rows that the loops allocate to them."""
    heads = Heads(2, 2, 5)
    interface = draw(torch.Generator().manual_seed(0), 1, heads.interface)
    loop = Loop(heads, 9)
    expected = loop.step(interface[0].numpy())
    reads, state = form(heads, interface, blank(heads, 9, (1,), interface))
    np.testing.assert_allclose(reads[0], expected, atol=1e-5)
    np.testing.assert_allclose(state.write_weights[0], loop.write, atol=1e-5)


@FORMS
@settings(max_examples=20)
@given(reads=st.integers(1, 4), writes=st.integers(1, 4), seed=st.integers(0, 999))
def test_weightings_stay_weightings(form: Form, reads: int, writes: int, seed: int) -> None:
    """Read modes are distributions; weightings, precedences and the rows and columns of links are >= 0, sums <= 1."""
    generator = torch.Generator().manual_seed(seed)
    heads = Heads(reads, writes, 4)
    state = blank(heads, 8, (3,), torch.zeros((), dtype=torch.float64))
    for _ in range(20):
        interface = draw(generator, 3, heads.interface, scale=5.0)
        modes = controls(heads, interface).read_modes
        torch.testing.assert_close(modes.sum(-1), torch.ones_like(modes[..., 0]))
        _, state = form(heads, interface, state)
        sums = (state.read_weights, state.write_weights, state.precedence, state.links, state.links.mT)
        assert all((part >= 0).all() and (part.sum(-1) <= 1 + 1e-9).all() for part in sums)
        assert (state.usage >= 0).all() and (state.usage <= 1).all()  # noqa: PT018  # one truth


@FORMS
def test_full_allocation_writes_the_freed_row(form: Form) -> None:
    """With every row used, what a head has read and frees is where an allocating head writes next."""
    heads = Heads(1, 1, 3)
    state = blank(heads, 5)
    state = state._replace(usage=torch.ones(5), read_weights=torch.eye(5)[None, 2], memory=torch.rand(3, 5))
    on, value = 20.0, [0.1, 0.2, 0.3]
    write = [0, 0, 0, 0, *value, on, on, on, on, on]  # key, strength, value, erase, allocation gate, write gate
    read = [0, 0, 0, 0, on, 0, 0, 0]  # key, strength, free gate, modes
    _, after = form(heads, torch.tensor(write + read), state)
    torch.testing.assert_close(after.write_weights[0], torch.eye(5)[2], atol=1e-5, rtol=0)
    torch.testing.assert_close(after.memory[:, 2], torch.tensor(value), atol=1e-5, rtol=0)
    torch.testing.assert_close(after.memory[:, [0, 1, 3, 4]], state.memory[:, [0, 1, 3, 4]], atol=1e-4, rtol=0)


def test_allocation_by_hand() -> None:
    """The least used row comes first, then the others by what those before left; of equals the first."""
    weights = allocation(torch.tensor([0.5, 0.25, 1.0, 0.25], dtype=torch.float64))
    expected = torch.tensor([0.5 * 0.0625, 0.75, 0.0, 0.25 * 0.75], dtype=torch.float64)
    torch.testing.assert_close(weights, expected, atol=1e-5, rtol=0)


@FORMS
def test_saturated_usage_gives_numbers(form: Form) -> None:
    """With all rows full, nothing freed and strong gates, values and gradients are finite."""
    heads = Heads(2, 2, 4)
    state = blank(heads, 6, (2,))
    state = state._replace(usage=torch.ones(2, 6), memory=1e3 * torch.ones(2, 4, 6))
    interface = torch.full((2, heads.interface), 20.0, requires_grad=True)
    loss = torch.zeros(())
    for _ in range(10):
        reads, state = form(heads, interface * torch.tensor([[1.0], [-1.0]]), state)
        loss = loss + reads.sum()
    loss.backward()
    assert interface.grad is not None
    assert interface.grad.isfinite().all()
    assert all(part.isfinite().all() for part in state)


@pytest.mark.parametrize(("form", "steps"), [(plain, 1000), (fast_access, 10_000)])
def test_many_random_steps_give_numbers(form: Form, steps: int) -> None:
    """In float32, with interfaces as strong as the clip lets them be."""
    heads = Heads(2, 2, 4)
    generator = torch.Generator().manual_seed(1)
    state = blank(heads, 8, (1,))
    for _ in range(steps):
        interface = draw(generator, 1, heads.interface, scale=10.0, dtype=torch.float32).clamp(-20, 20)
        reads, state = form(heads, interface, state)
        assert reads.isfinite().all()
    assert all(part.isfinite().all() for part in state)


@pytest.mark.parametrize(("links", "kept"), [(True, 0), (True, 2), (False, 0)])
def test_a_network_is_the_same_plain_and_fast(links: bool, kept: int) -> None:
    """Outputs, states and the gradients of all parameters agree over a sequence."""
    heads = Heads(2, 2, 4, links, kept)
    torch.manual_seed(0)
    networks = [DNC(3, 5, heads, rows=6, hidden=16, fast=fast).double() for fast in (False, True)]
    networks[1].load_state_dict(networks[0].state_dict())
    sequence = torch.randn(4, 7, 3, dtype=torch.float64)
    start = networks[0].blank((4,))._replace(access=used(heads, 6, 4, torch.Generator().manual_seed(0)))
    (plain_outputs, plain_state), (outputs, state) = (network(sequence, start) for network in networks)
    assert outputs.shape == (4, 7, 5)
    torch.testing.assert_close(outputs, plain_outputs)
    torch.testing.assert_close(state, plain_state)
    for result in (plain_outputs, outputs):
        result.square().sum().backward()
    for mine, theirs in zip(networks[1].parameters(), networks[0].parameters(), strict=True):
        torch.testing.assert_close(mine.grad, theirs.grad)


@pytest.mark.parametrize("fast", [True, False])
def test_one_sample_is_a_batch_of_one(fast: bool) -> None:
    """Without a batch, shapes lose it and numbers stay; step by step is the same as in one go."""
    network = DNC(3, 5, Heads(), rows=6, hidden=16, fast=fast)
    sequence = torch.randn(7, 3)
    outputs, state = network(sequence)
    batched, _ = network(sequence[None])
    torch.testing.assert_close(outputs, batched[0])
    assert state.access.memory.shape == (8, 6)
    _, middle = network(sequence[:4])
    rest, _ = network(sequence[4:], middle)
    torch.testing.assert_close(rest, outputs[4:])


@pytest.mark.parametrize("rows", [1, 6, 16, 33, 64])
@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
@pytest.mark.parametrize("batch", [(), (1,)])
@pytest.mark.parametrize(("links", "kept"), [(True, 0), (True, 3), (False, 0)])
def test_a_single_step_is_that_with_gradients(
    links: bool, kept: int, batch: tuple[int, ...], dtype: torch.dtype, rows: int
) -> None:
    """Once settled, a step of one sample runs in one call, to the same outputs and states, clipped or not."""
    torch.manual_seed(0)
    network = DNC(3, 5, Heads(2, 2, 4, links, kept), rows=rows, hidden=16, clip=1).to(dtype)
    with torch.no_grad():
        for parameter in (*network.controller.parameters(), *network.output.parameters()):
            parameter.mul_(8)
    sequence = torch.randn(*batch, 7, 3, dtype=dtype)
    parts = used(network.heads, rows, 1, torch.Generator().manual_seed(0))
    drawn = AccessState(*(part.to(dtype).reshape(*batch, *part.shape[1:]) for part in parts))
    start = network.blank(batch)._replace(access=drawn)
    expected = network(sequence, start)
    network.settle()
    outputs, state = network(sequence, start)
    torch.testing.assert_close((outputs, state), expected)
    assert not outputs.requires_grad
    assert state.cell.abs().max() == outputs.abs().max() == 1


@pytest.mark.parametrize("fast", [True, False])
def test_an_empty_batch_steps(fast: bool) -> None:
    """No samples give no outputs, a state of none, and gradients of zero."""
    network = DNC(3, 5, Heads(), rows=6, hidden=16, fast=fast)
    outputs, state = network(torch.randn(0, 7, 3))
    assert outputs.shape == (0, 7, 5)
    assert state.access.links.shape == (0, 1, 6, 6)
    outputs.sum().backward()
    assert all(parameter.grad is not None and not parameter.grad.any() for parameter in network.parameters())
    with torch.no_grad():
        assert network(torch.randn(0, 7, 3))[0].shape == (0, 7, 5)


def test_rows_may_change_after_training() -> None:
    """The same parameters work with another number of rows."""
    network = DNC(3, 5, Heads(), rows=6, hidden=16)
    names = set(network.state_dict())
    network.rows = 50
    outputs, state = network(torch.randn(2, 3, 3))
    assert outputs.shape == (2, 3, 5)
    assert state.access.links.shape == (2, 1, 50, 50)
    assert set(network.state_dict()) == names


def test_cell_and_outputs_are_clipped() -> None:
    """Neither leaves +-clip, however large the weights."""
    network = DNC(3, 5, Heads(), rows=6, hidden=16, clip=1)
    with torch.no_grad():
        for parameter in network.parameters():
            parameter.mul_(100)
    outputs, state = network(torch.randn(2, 9, 3))
    assert outputs.abs().max() == 1
    assert state.cell.abs().max() == 1
