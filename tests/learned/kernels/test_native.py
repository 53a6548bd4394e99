"""Jobs run by PyTorch's threads are all done, each of their blocks once."""

import os
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
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


WRITE = """
import sys
import torch
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.dnc.job import JOB, sizes_of, state_of, tape_of
from fogbench.learned.dnc.layout import layout
from fogbench.learned.dnc.rows import write
from fogbench.learned.kernels.native import Loop
from fogbench.worlds.kernel import kernel

@kernel
def once(number, job, block):
    old = state_of(number, job.old, job.old_links, job, block)
    new = state_of(number, job.new, job.new_links, job, block)
    write(sizes_of(job), tape_of(number, job, block).write_heads, old.memory, new.write_weights, new.memory)

@kernel
def twice(number, job, block):
    once(number, job, block)
    once(number, job, block)

lies = layout(Heads(writes=2), 8, (3,))
random = torch.Generator().manual_seed(0)
tape, old, new, links = (torch.rand(size, generator=random) for size in (lies.tape, lies.rest, lies.rest, lies.links))
for work in [twice, once] if sys.argv[1:] else [once]:
    Loop(work, JOB).run(new.dtype, lies.blocks, lies.sizes, (None, old, links, new, links, None, tape))
print(new.numpy().tobytes().hex())
"""
"""Prints what a kernel makes of which the optimiser makes other code in a loop than by itself."""


def test_a_loop_computes_the_same_in_all_processes(tmp_path: Path) -> None:
    """Bit for bit: where it is compiled, kept or not, where it is read, and where its kernels were in use before."""
    (tmp_path / "script.py").write_text(WRITE)
    results = [
        subprocess.check_output(
            [sys.executable, "script.py", *others], cwd=tmp_path, env={**os.environ, "NUMBA_CACHE_DIR": place}
        )
        for place, *others in [("/proc/kernels",), ("kernels",), ("kernels",), ("kernels", "before")]
    ]
    assert results[0]
    assert results == results[:1] * 4
