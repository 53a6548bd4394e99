"""What the loops of the memory access are told, and a block of the arrays that this stands for.

A block is sixteen samples side by side. An array of a block is flat and has one row for each number of a sample; the
letters are those of `fogbench.learned.dnc.access`.

Words used here
    sizes        D, N, R, W, K
    write_heads  [W * (3 * D + 3)], for each write head key, strength, value, erase vector, allocation gate, write gate
    read_heads   [R * (D + 2 * K + 3)], for each read head key, strength, free gate, modes
    similar      [heads * N], weightings by content
    before       [W * N], what each row is allocated by the rows that come before it: the product of their usages
    d_x          the gradient of the loss by x
"""

from typing import Any, NamedTuple

from numba import carray  # type: ignore[attr-defined]  # it does

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.native import job, pointer
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

Sizes = tuple[int, int, int, int, int]

SIZES = "samples", "pitch", "word", "rows", "reads", "writes", "linked"
STATES = "old", "old_links", "new", "new_links"
JOB = job(
    *SIZES, "interface", *STATES, "read", "tape",
    "d_read", "d_new", "d_new_links", "d_old", "d_old_links", "d_interface",
)  # fmt: skip
"""Sizes, then addresses: an interface [B, I]; states [rows, pitch] but for their links, and links [K * N * N, pitch],
where the samples stand side by side, `pitch` numbers from row to row; what is read [B, R * D]; the tape [rows, pitch];
and gradients by these."""


class Tape(NamedTuple):
    """What a step leaves for its way back."""

    write_heads: Array
    read_heads: Array
    before: Array
    write_similar: Array
    read_similar: Array
    old_lengths: Array
    """[N], the norms of the memory's rows before the step."""
    new_lengths: Array
    """[N], after it."""


@kernel
def sizes_of(job: Any) -> Sizes:
    """The sizes in a job."""
    return job.word, job.rows, job.reads, job.writes, job.linked


@kernel
def interface_size(sizes: Sizes) -> int:
    """`I`."""
    word, _, reads, writes, linked = sizes
    return writes * (3 * word + 3) + reads * (word + 2 * linked + 3)


@kernel
def samples_of(number: Any, address: int, size: int, job: Any, block: int) -> Array:
    """[at most 16, size] the samples of a block of an array [B, size]."""
    return carray(pointer(address), (job.samples, size), number)[block * LANES : (block + 1) * LANES]


@kernel
def block_of(number: Any, address: int, rows: int, job: Any, block: int) -> Array:
    """[rows, 16] a block of an array [rows, pitch]."""
    array = carray(pointer(address), (rows, job.pitch), number)
    return array[:, block * LANES : (block + 1) * LANES]


@kernel
def state_of(number: Any, state: int, links: int, job: Any, block: int) -> AccessState[Array]:
    """A block of a state, of the addresses of its links and of all else."""
    word, rows, reads, writes, linked = sizes_of(job)
    a = word * rows
    b = a + reads * rows
    c = b + writes * rows
    d = c + rows
    rest = block_of(number, state, d + linked * rows, job, block)
    own = block_of(number, links, linked * rows * rows, job, block)
    return AccessState(rest[:a], rest[a:b], rest[b:c], rest[c:d], own, rest[d:])


@kernel
def tape_of(number: Any, job: Any, block: int) -> Tape:
    """A block of the tape."""
    return taped(sizes_of(job), block_of(number, job.tape, tape_size(sizes_of(job)), job, block))


@kernel
def tape_size(sizes: Sizes) -> int:
    """Rows of a tape."""
    _, rows, reads, writes, _ = sizes
    return interface_size(sizes) + rows * (2 * writes + reads + 2)


@kernel
def taped(sizes: Sizes, tape: Array) -> Tape:
    """The parts of a tape."""
    word, rows, reads, writes, _ = sizes
    a = writes * (3 * word + 3)
    b = interface_size(sizes)
    c = b + writes * rows
    d = c + writes * rows
    e = d + reads * rows
    return Tape(tape[:a], tape[a:b], tape[b:c], tape[c:d], tape[d:e], tape[e : e + rows], tape[e + rows :])
