"""The loops of one step of the memory access, sixteen samples at a time; the way back is in `learned.dnc_kernels_back`.

`learned.dnc_access` has their equations and their letters, `learned.lanes` their numbers: each is that of all samples
of a block. An array is flat and has one row for each number of a sample.

Words used here
    sizes        D, N, R, W, K
    write_heads  [W * (3 * D + 3)], for each write head key, strength, value, erase vector, allocation gate, write gate
    read_heads   [R * (D + 2 * K + 3)], for each read head key, strength, free gate, modes
    similar      [heads * N], weightings by content
    before       [W * N], what each row is allocated by the rows that come before it: the product of their usages
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # it does

from learned.dnc_access import EPSILON, AccessState
from learned.lanes import LANES, at, decay, full, larger, put, root, sigmoid, softplus, until
from learned.native import job, pointer, take
from worlds.kernel import callback, fused, kernel
from worlds.types import Array

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
def taped(sizes: Sizes, tape: Array) -> Tape:
    """The parts of a tape."""
    word, rows, reads, writes, linked = sizes
    a = writes * (3 * word + 3)
    b = a + reads * (word + 2 * linked + 3)
    c = b + writes * rows
    d = c + writes * rows
    e = d + reads * rows
    return Tape(tape[:a], tape[a:b], tape[b:c], tape[c:d], tape[d:e], tape[e : e + rows], tape[e + rows :])


@kernel
def parts(sizes: Sizes, state: Array, links: Array) -> AccessState[Array]:
    """The parts of a state."""
    word, rows, reads, writes, _ = sizes
    a = word * rows
    b = a + reads * rows
    c = b + writes * rows
    return AccessState(state[:a], state[a:b], state[b:c], state[c : c + rows], links, state[c + rows :])


@kernel
def sizes_of(job: Any) -> Sizes:
    """The sizes in a job."""
    return job.word, job.rows, job.reads, job.writes, job.linked


@kernel
def block_of(number: Any, address: int, rows: int, job: Any, block: int) -> Array:
    """[rows, 16] a block of an array [rows, pitch]."""
    array = carray(pointer(address), (rows, job.pitch), number)
    return array[:, block * LANES : (block + 1) * LANES]


@kernel
def state_of(number: Any, state: int, links: int, job: Any, block: int) -> AccessState[Array]:
    """A block of a state, of the addresses of its links and of all else."""
    word, rows, reads, writes, linked = sizes_of(job)
    rest = block_of(number, state, rows * (word + reads + writes + 1 + linked), job, block)
    return parts(sizes_of(job), rest, block_of(number, links, linked * rows * rows, job, block))


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
def interface_size(sizes: Sizes) -> int:
    """`I`."""
    word, _, reads, writes, linked = sizes
    return writes * (3 * word + 3) + reads * (word + 2 * linked + 3)


@kernel
def samples_of(number: Any, address: int, size: int, job: Any, block: int) -> Array:
    """[at most 16, size] the samples of a block of an array [B, size]."""
    return carray(pointer(address), (job.samples, size), number)[block * LANES : (block + 1) * LANES]


@lru_cache
def forward(number: type[np.floating[Any]]) -> int:
    """The address of the loop of one step for a type of numbers: it needs the job's fields as far as `tape`."""

    def loop(address: Any) -> None:
        job = carray(address, 1, JOB)[0]
        block = take(address)
        while block < job.blocks:
            old = state_of(number, job.old, job.old_links, job, block)
            new = state_of(number, job.new, job.new_links, job, block)
            interface = samples_of(number, job.interface, interface_size(sizes_of(job)), job, block)
            reads = samples_of(number, job.read, job.reads * job.word, job, block)
            step(sizes_of(job), interface, old, new, reads, tape_of(number, job, block))
            block = take(address)

    return callback(loop)


@kernel
def step(
    sizes: Sizes, interface: Array, old: AccessState[Array], new: AccessState[Array], reads: Array, tape: Tape
) -> None:
    """One step of one block."""
    word, _, readers, writers, linked = sizes
    activate(sizes, interface, tape.write_heads, tape.read_heads)
    use(sizes, tape.read_heads, old, new.usage)
    address(word, writers, tape.write_heads, old.memory, tape.old_lengths, tape.write_similar)
    allocate(sizes, tape.write_heads, new.usage, tape.write_similar, tape.before, new.write_weights)
    write(sizes, tape.write_heads, old.memory, new.write_weights, new.memory)
    link(linked, old.links, old.precedence, new.write_weights, new.links, new.precedence)
    address(word, readers, tape.read_heads, new.memory, tape.new_lengths, tape.read_similar)
    follow(sizes, tape.read_heads, new.links, old.read_weights, tape.read_similar, new.read_weights)
    read(sizes, new.memory, new.read_weights, reads)


@kernel
def activate(sizes: Sizes, interface: Array, write_heads: Array, read_heads: Array) -> None:
    """The controls in an interface: strengths by softplus, gates and erase vectors by sigmoid, modes by softmax."""
    word, _, readers, writers, linked = sizes
    lay(interface[:, : len(write_heads)], write_heads)
    lay(interface[:, len(write_heads) :], read_heads)
    size = 3 * word + 3
    for i in range(writers):
        head = write_heads[i * size : (i + 1) * size]
        put(head, word, softplus(at(head, word)))
        for k in range(2 * word + 1, size):
            put(head, k, sigmoid(at(head, k)))
    size = word + 2 * linked + 3
    for j in range(readers):
        head = read_heads[j * size : (j + 1) * size]
        put(head, word, softplus(at(head, word)))
        put(head, word + 1, sigmoid(at(head, word + 1)))
        softmax(head[word + 2 :])


@kernel
def lay(samples: Array, rows: Array) -> None:
    """Samples side by side: [samples, any] becomes [any, samples], with zeros where a block is not full."""
    for k in range(rows.shape[0]):
        put(rows, k, full(rows, 0))
    for lane in range(samples.shape[0]):
        for k in range(rows.shape[0]):
            rows[k, lane] = samples[lane, k]


@fused
def softmax(scores: Array) -> None:
    """Make scores a distribution."""
    highest = at(scores, 0)
    for n in range(1, len(scores)):
        highest = larger(highest, at(scores, n))
    total = full(scores, 0)
    for n in range(len(scores)):
        e = decay(at(scores, n) - highest)
        total += e
        put(scores, n, e)
    share = 1 / total
    for n in range(len(scores)):
        put(scores, n, at(scores, n) * share)


@fused
def use(sizes: Sizes, read_heads: Array, old: AccessState[Array], usage: Array) -> None:
    """Rows written before are used, rows read before and freed are not."""
    word, rows, readers, writers, linked = sizes
    for n in range(rows):
        unused = 1 - at(old.usage, n)
        for i in range(writers):
            unused *= 1 - at(old.write_weights, i * rows + n)
        used = 1 - unused
        for j in range(readers):
            used *= 1 - at(read_heads, j * (word + 2 * linked + 3) + word + 1) * at(old.read_weights, j * rows + n)
        put(usage, n, used)


@fused
def address(word: int, count: int, heads: Array, memory: Array, lengths: Array, similar: Array) -> None:
    """The weightings by cosine similarity of keys and rows, and the rows' lengths."""
    rows, size = len(lengths), len(heads) // count
    for n in range(rows):
        put(lengths, n, length(memory[n:], word, rows))
    for i in range(count):
        head, scores = heads[i * size : (i + 1) * size], similar[i * rows : (i + 1) * rows]
        own, strength = length(head, word, 1), at(head, word)
        for n in range(rows):
            put(scores, n, strength * product(head, memory[n:], word, rows) / (own * at(lengths, n) + EPSILON))
        softmax(scores)


@fused
def length(vector: Array, word: int, pitch: int) -> Any:
    """The norm of `word` numbers, `pitch` apart."""
    square = full(vector, EPSILON)
    for d in range(word):
        square += at(vector, d * pitch) * at(vector, d * pitch)
    return root(square)


@fused
def product(key: Array, vector: Array, word: int, pitch: int) -> Any:
    """The scalar product of a key and `word` numbers, `pitch` apart."""
    total = full(key, 0)
    for d in range(word):
        total += at(key, d) * at(vector, d * pitch)
    return total


@fused
def allocate(sizes: Sizes, heads: Array, usage: Array, similar: Array, before: Array, weights: Array) -> None:
    """The write weightings; a head sees as used what the heads before it are allocated."""
    word, rows, _, writers, _ = sizes
    used = np.empty((rows, LANES), usage.dtype)
    for n in range(rows):
        put(used, n, raised(at(usage, n)))
    for i in range(writers):
        allocation, gate = at(heads, (i + 1) * (3 * word + 3) - 2), at(heads, (i + 1) * (3 * word + 3) - 1)
        precede(used, before[i * rows :])
        for n in range(rows):
            k, u = i * rows + n, at(used, n)
            free = (1 - u) * at(before, k)
            put(weights, k, gate * (allocation * free + (1 - allocation) * at(similar, k)))
            put(used, n, u + (1 - u) * allocation * gate * free)


@fused
def raised(usage: Any) -> Any:
    """A usage that is not zero."""
    return EPSILON + (1 - EPSILON) * usage


@fused
def precede(used: Array, before: Array) -> None:
    """For each row the product of the usages of the rows less used, or as much and earlier; this needs no sorting."""
    rows = len(used)
    for n in range(rows):
        u, product = at(used, n), full(used, 1)
        for m in range(n):
            product *= until(at(used, m), u, at(used, m), 1)
        for m in range(n + 1, rows):
            product *= until(u, at(used, m), 1, at(used, m))
        put(before, n, product)


@fused
def write(sizes: Sizes, heads: Array, memory: Array, weights: Array, new_memory: Array) -> None:
    """All heads erase, then all add."""
    word, rows, _, writers, _ = sizes
    for d in range(word):
        for n in range(rows):
            kept, added = at(memory, d * rows + n), full(memory, 0)
            for i in range(writers):
                head, w = i * (3 * word + 3), at(weights, i * rows + n)
                kept *= 1 - at(heads, head + 2 * word + 1 + d) * w
                added += at(heads, head + word + 1 + d) * w
            put(new_memory, d * rows + n, kept + added)


@fused
def link(linked: int, links: Array, precedence: Array, weights: Array, new_links: Array, new_precedence: Array) -> None:
    """Rows written now follow the rows written last."""
    rows = len(precedence) // max(linked, 1)
    for i in range(linked):
        w, p = weights[i * rows :], precedence[i * rows :]
        kept = full(weights, 1)
        for n in range(rows):
            to, first = at(w, n), (i * rows + n) * rows
            for m in range(rows):
                put(new_links, first + m, (1 - to - at(w, m)) * at(links, first + m) + to * at(p, m))
            put(new_links, first + n, full(links, 0))
            kept -= to
        for n in range(rows):
            put(new_precedence, i * rows + n, kept * at(p, n) + at(w, n))


@fused
def follow(sizes: Sizes, heads: Array, links: Array, before: Array, similar: Array, weights: Array) -> None:
    """The read weightings: by content, and backward and forward along the links."""
    word, rows, readers, _, linked = sizes
    size = word + 2 * linked + 3
    ahead, back = np.empty((readers * rows, LANES), before.dtype), np.empty((readers * rows, LANES), before.dtype)
    for j in range(readers):
        content = at(heads, (j + 1) * size - 1)
        for n in range(j * rows, (j + 1) * rows):
            put(weights, n, content * at(similar, n))
    for i in range(linked):
        along(rows, readers, links[i * rows * rows :], before, ahead, back)
        for j in range(readers):
            mode = j * size + word + 2 + i
            backward, forward = at(heads, mode), at(heads, mode + linked)
            for n in range(j * rows, (j + 1) * rows):
                put(weights, n, at(weights, n) + backward * at(back, n) + forward * at(ahead, n))


@fused
def along(rows: int, count: int, links: Array, vectors: Array, ahead: Array, back: Array) -> None:
    """The products of links and of transposed links with `count` vectors of rows."""
    for n in range(count * rows):
        put(back, n, full(back, 0))
    for n in range(0, rows, 2):  # two rows at a time, which share what they load
        last = min(n + 1, rows - 1)
        for j in range(0, count * rows, rows):
            x, y = at(vectors, j + n), at(vectors, j + last)
            if last == n:
                y = full(vectors, 0)
            ahead_x, ahead_y = full(ahead, 0), full(ahead, 0)
            for m in range(rows):
                of_x, of_y, v = at(links, n * rows + m), at(links, last * rows + m), at(vectors, j + m)
                ahead_x += of_x * v
                ahead_y += of_y * v
                put(back, j + m, at(back, j + m) + of_x * x + of_y * y)
            put(ahead, j + last, ahead_y)
            put(ahead, j + n, ahead_x)


@fused
def read(sizes: Sizes, memory: Array, weights: Array, reads: Array) -> None:
    """The rows, weighted."""
    word, rows, readers, _, _ = sizes
    found = np.empty((1, LANES), memory.dtype)
    for j in range(readers):
        for d in range(word):
            total = full(memory, 0)
            for n in range(rows):
                total += at(weights, j * rows + n) * at(memory, d * rows + n)
            put(found, 0, total)
            for lane in range(len(reads)):
                reads[lane, j * word + d] = found[0, lane]
