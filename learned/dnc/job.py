"""The jobs of the memory access, and a block of the arrays that their addresses stand for.

A block is sixteen samples side by side. An array of a block is flat and has one row for each number of a sample; the
letters are those of `fogbench.learned.dnc.access`. Or a block is one sample `alone`, whose memory rows lie side by
side, sixteen by sixteen, the last ones unused; then a number that belongs to no memory row is in all lanes, and the
gradient by it is the sum of all.

Words used here
    sizes        D, N, R, W, K, 0 and S; or, of a sample that is alone, N counts sixteen rows as one, and stands for 0
    write_heads  [W * (3 * D + 3)], for each write head key, strength, value, erase vector, allocation gate, write gate
    read_heads   [R * (D + 2 * K + 3)], for each read head key, strength, free gate, modes
    similar      [heads * N], weightings by content
    before       [W * N], what each row is allocated by the rows that come before it: the product of their usages
    d_x          the gradient of the loss by x
"""

from math import prod
from typing import Any, Generic, NamedTuple

from numba import carray  # type: ignore[attr-defined]  # it does

from fogbench.learned.dnc.access import AccessState, T
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.native import job, pointer
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

Sizes = tuple[int, int, int, int, int, int, int]


class Tape(NamedTuple, Generic[T]):
    """What a step leaves for its way back."""

    write_heads: T
    read_heads: T
    before: T
    write_similar: T
    read_similar: T
    old_lengths: T
    """[N], the norms of the memory's rows before the step."""
    new_lengths: T
    """[N], after it."""


def tape_sizes(heads: Heads, rows: int) -> Tape[int]:
    """How many numbers of a sample each part has."""
    writers, readers = map(prod, heads.interface_shapes)
    write, read = heads.writes * rows, heads.reads * rows
    return Tape(writers, readers, write, write, read, rows, rows)


ENDS = tuple(f"{part}_end" for part in (*AccessState._fields, *Tape._fields))
"""Where the parts of a state and of a tape end, each in its buffer, where it follows on the part before."""
SIZES = "samples", "pitch", "interface_size", "word", "rows", "reads", "writes", "linked", "alone", "strongest", *ENDS
STATES = "old", "old_links", "new", "new_links"
JOB = job(
    *SIZES, "interface", *STATES, "read", "tape",
    "d_read", "d_new", "d_new_links", "d_old", "d_old_links", "d_interface",
)  # fmt: skip
"""Sizes, then addresses: an interface [B, I]; states but for their links, and links, as `fogbench.learned.dnc.layout`
has them, `pitch` numbers from row to row; what is read [B, R * D]; the tape [rows, pitch]; and gradients by these, of
which those by links may be nowhere."""


@kernel
def sizes_of(job: Any) -> Sizes:
    """The sizes in a job."""
    return job.word, job.rows, job.reads, job.writes, job.linked, job.alone, job.strongest


@kernel
def head_size(heads: Array, count: int) -> int:
    """How many numbers each of so many heads has."""
    return len(heads) // count


@kernel
def samples_of(number: Any, address: int, size: int, job: Any, block: int) -> Array:
    """[at most 16, size] the samples of a block of an array [B, size]."""
    most = 1 if job.alone else LANES
    return carray(pointer(address), (job.samples, size), number)[block * most : (block + 1) * most]


@kernel
def block_of(number: Any, address: int, rows: int, job: Any, block: int) -> Array:
    """[rows, 16] a block of an array [rows, pitch], or of one sample [samples * rows, 16]; none of an array nowhere."""
    first, lane = (block * rows, 0) if job.alone else (0, block * LANES)
    array = carray(pointer(address), (first + rows, job.pitch), number)
    return array[first if address else len(array) :, lane : lane + LANES]


@kernel
def state_of(number: Any, state: int, links: int, job: Any, block: int) -> AccessState[Array]:
    """A block of a state, of the addresses of its links and of all else."""
    rest = block_of(number, state, job.precedence_end, job, block)
    own = block_of(number, links, job.links_end, job, block)
    return AccessState(
        rest[: job.memory_end],
        rest[job.memory_end : job.read_weights_end],
        rest[job.read_weights_end : job.write_weights_end],
        rest[job.write_weights_end : job.usage_end],
        own,
        rest[job.usage_end :],
    )


@kernel
def tape_of(number: Any, job: Any, block: int) -> Tape[Array]:
    """A block of the tape."""
    return taped(job, block_of(number, job.tape, job.new_lengths_end, job, block))


@kernel
def taped(job: Any, tape: Array) -> Tape[Array]:
    """The parts of a tape."""
    return Tape(
        tape[: job.write_heads_end],
        tape[job.write_heads_end : job.read_heads_end],
        tape[job.read_heads_end : job.before_end],
        tape[job.before_end : job.write_similar_end],
        tape[job.write_similar_end : job.read_similar_end],
        tape[job.read_similar_end : job.old_lengths_end],
        tape[job.old_lengths_end :],
    )
