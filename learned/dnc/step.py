"""One step of the memory access and the way back through it: of sixteen samples, or of sixteen rows of one at a time.

The file `access` has the equations and their letters, `kernels/lanes` the numbers: each is that of all samples of a
block, or of all its rows. Each loop gets `fogbench.learned.dnc.job.JOB`, of which it needs some fields.
"""

from typing import Any

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.activation import activate, activate_back
from fogbench.learned.dnc.allocation import allocate, allocate_back, use, use_back
from fogbench.learned.dnc.content import address, address_back, recall, recall_back
from fogbench.learned.dnc.job import JOB, Sizes, Tape, samples_of, sizes_of, state_of, tape_of
from fogbench.learned.dnc.links import link, link_again
from fogbench.learned.dnc.links_back import links_back
from fogbench.learned.dnc.rows import read, read_back, write, write_back
from fogbench.learned.kernels.lane_arrays import clear, same, zeros
from fogbench.learned.kernels.native import Loop
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array


@kernel
def forward(number: Any, job: Any, block: int) -> None:
    """One step; needs the fields as far as `tape`."""
    old = state_of(number, job.old, job.old_links, job, block)
    new = state_of(number, job.new, job.new_links, job, block)
    interface = samples_of(number, job.interface, job.interface_size, job, block)
    reads = samples_of(number, job.read, job.reads * job.word, job, block)
    step(sizes_of(job), interface, old, new, reads, tape_of(number, job, block))


@kernel
def backward(number: Any, job: Any, block: int) -> None:
    """Back through one step, with zeros by past write weightings; needs all fields but `interface` and `new_links`."""
    old = state_of(number, job.old, job.old_links, job, block)
    new = state_of(number, job.new, job.old_links, job, block)
    d_new = state_of(number, job.d_new, job.d_new_links, job, block)
    d_old = state_of(number, job.d_old, job.d_old_links, job, block)
    d_reads = samples_of(number, job.d_read, job.reads * job.word, job, block)
    d_interface = samples_of(number, job.d_interface, job.interface_size, job, block)
    step_back(sizes_of(job), old, new, tape_of(number, job, block), d_reads, d_new, d_old, d_interface)


@kernel
def relink(number: Any, job: Any, block: int) -> None:
    """Make `new_links` again, of `old`, `old_links` and `new`."""
    old = state_of(number, job.old, job.old_links, job, block)
    new = state_of(number, job.new, job.new_links, job, block)
    link_again(sizes_of(job), old, new)


@kernel
def step(
    sizes: Sizes, interface: Array, old: AccessState[Array], new: AccessState[Array], reads: Array, tape: Tape[Array]
) -> None:
    """One step of one block."""
    _, _, readers, writers, _, _, _ = sizes
    activate(sizes, interface, tape.write_heads, tape.read_heads)
    use(sizes, tape.read_heads, old, new.usage)
    address(sizes, writers, tape.write_heads, old.memory, tape.old_lengths, tape.write_similar)
    allocate(sizes, tape.write_heads, new.usage, tape.write_similar, tape.before, new.write_weights)
    write(sizes, tape.write_heads, old.memory, new.write_weights, new.memory)
    address(sizes, readers, tape.read_heads, new.memory, tape.new_lengths, tape.read_similar)
    recall(readers, tape.read_heads, tape.read_similar, new.read_weights)
    link(sizes, tape.read_heads, old, new)
    read(sizes, new.memory, new.read_weights, reads)


@kernel
def step_back(
    sizes: Sizes, old: AccessState[Array], new: AccessState[Array], tape: Tape[Array], d_reads: Array,
    d_new: AccessState[Array], d_old: AccessState[Array], d_interface: Array,
) -> None:  # fmt: skip
    """Back through one step of one block. The links of `new` are not looked at."""
    _, _, readers, writers, _, _, _ = sizes
    d_write_heads, d_read_heads = zeros(tape.write_heads), zeros(tape.read_heads)
    d_memory, d_usage = same(d_new.memory), same(d_new.usage)
    d_read, d_write = same(d_new.read_weights), same(d_new.write_weights)
    d_read_similar, d_write_similar = zeros(d_read), zeros(d_write)
    for part in (d_old.memory, d_old.read_weights, d_old.write_weights, d_old.precedence):
        clear(part)
    read_back(sizes, new.memory, new.read_weights, d_reads, d_memory, d_read)
    recall_back(readers, tape.read_heads, tape.read_similar, d_read, d_read_heads, d_read_similar)
    links_back(sizes, tape.read_heads, old, new.write_weights, d_read, d_new, d_old, d_read_heads, d_write)
    address_back(
        sizes, readers, tape.read_heads, new.memory, tape.new_lengths, tape.read_similar, d_read_similar,
        d_read_heads, d_memory,
    )  # fmt: skip
    write_back(sizes, tape.write_heads, old.memory, new.write_weights, d_memory, d_write_heads, d_old.memory, d_write)
    allocate_back(
        sizes, tape.write_heads, new.usage, tape.write_similar, tape.before, d_write,
        d_write_heads, d_write_similar, d_usage,
    )  # fmt: skip
    address_back(
        sizes, writers, tape.write_heads, old.memory, tape.old_lengths, tape.write_similar, d_write_similar,
        d_write_heads, d_old.memory,
    )  # fmt: skip
    use_back(sizes, tape.read_heads, old, d_usage, d_read_heads, d_old.read_weights, d_old.usage)
    activate_back(sizes, tape.write_heads, tape.read_heads, d_write_heads, d_read_heads, d_interface)


FORWARD, BACKWARD, RELINK = Loop(forward, JOB), Loop(backward, JOB), Loop(relink, JOB)
