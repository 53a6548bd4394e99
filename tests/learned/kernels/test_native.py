"""Jobs run by PyTorch's threads are all done, each of their blocks once."""

from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest
import torch
from numba import carray  # type: ignore[attr-defined]  # it does

from fogbench.learned.kernels import native
from fogbench.learned.kernels.native import job, pointer, run, take
from fogbench.worlds.kernel import callback

JOB = job("counts", "one")


@cache
def count() -> int:
    """The address of a loop that adds `one` to each block's count."""

    def loop(address: Any) -> None:
        job = carray(address, 1, JOB)[0]
        counts = carray(pointer(job.counts), job.blocks, np.int64)
        block = take(address)
        while block < job.blocks:
            counts[block] += job.one
            block = take(address)

    return callback(loop)


@pytest.fixture(params=[1, 2, 4])
def threads(request: pytest.FixtureRequest) -> Iterator[None]:
    """As many threads of PyTorch for a while."""
    before = torch.get_num_threads()
    torch.set_num_threads(request.param)
    yield
    torch.set_num_threads(before)


@pytest.mark.usefixtures("threads")
@pytest.mark.parametrize("blocks", [0, 1, 2, 5, 1000])
def test_every_block_is_done_once(blocks: int) -> None:
    """Whatever the threads: many blocks, fewer blocks than threads, or none, and nothing beyond the last."""
    counts = np.zeros(blocks + 1, np.int64)
    run(count(), blocks, counts.ctypes.data, 7)
    assert counts.tolist() == [7] * blocks + [0]


@pytest.mark.usefixtures("threads")
def test_without_openmp(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no OpenMP library is found, the same is done in the calling thread."""
    monkeypatch.setattr(native, "_PARALLEL", None)
    test_every_block_is_done_once(5)
