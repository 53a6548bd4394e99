"""Jobs run by PyTorch's threads are all done, each of their blocks once."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import torch

from fogbench.learned.kernels import native
from fogbench.learned.kernels.native import Loop, job, vector
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

FORM = job("size", "amount", "counts", "turns")


@kernel
def count(number: Any, job: Any, block: int) -> None:
    """Add `amount` to the count of a block."""
    vector(number, job.counts, job.size)[block] += job.amount


@kernel
def one(number: Any, _job: Any) -> tuple[Array]:
    """A zero for each thread."""
    return (np.zeros(1, number),)


@kernel
def count_turns(number: Any, job: Any, block: int, turn: Array) -> None:
    """Tell which of its thread's blocks a block is, from 1 on."""
    turn[0] += 1
    vector(number, job.turns, job.size)[block] = turn[0]


@pytest.fixture(params=[1, 2, 4])
def threads(request: pytest.FixtureRequest) -> Iterator[int]:
    """As many threads of PyTorch for a while."""
    before = torch.get_num_threads()
    torch.set_num_threads(request.param)
    yield request.param
    torch.set_num_threads(before)


@pytest.mark.usefixtures("threads")
@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
@pytest.mark.parametrize("blocks", [0, 1, 2, 5, 1000])
def test_every_block_is_done_once(blocks: int, dtype: torch.dtype) -> None:
    """Whatever the threads: many blocks, fewer blocks than threads, or none, and nothing beyond the last."""
    counts = torch.zeros(blocks + 1, dtype=dtype)
    Loop(count, FORM).run(dtype, blocks, (len(counts), 7), (counts, None))
    assert counts.tolist() == [7] * blocks + [0]


@pytest.mark.parametrize("blocks", [0, 1, 1000])
def test_every_thread_has_room_of_its_own(blocks: int, threads: int) -> None:
    """What a thread keeps from block to block is touched by no other, and is made once."""
    turns = torch.zeros(blocks, dtype=torch.float64)
    Loop(count_turns, FORM, one).run(turns.dtype, blocks, (blocks, 0), (None, turns))
    values, counts = np.unique(turns.numpy(), return_counts=True)
    assert values.tolist() == list(range(1, len(values) + 1))
    assert all(more >= less for more, less in pairwise(counts))
    assert counts[:1].max(initial=0) <= threads


@pytest.mark.usefixtures("threads")
def test_without_openmp(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no OpenMP library is found, the same is done in the calling thread."""
    monkeypatch.setattr(native, "_PARALLEL", None)
    test_every_block_is_done_once(5, torch.float64)
