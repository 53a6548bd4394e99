"""From an interface to the controls of a memory access, forward and back."""

from fogbench.learned.dnc.job import Sizes, head_size
from fogbench.learned.kernels.functions import decay, sigmoid, softplus
from fogbench.learned.kernels.instructions import at, put
from fogbench.learned.kernels.lane_arrays import lay, softmax, softmax_back, unlay
from fogbench.worlds.kernel import fused, kernel
from fogbench.worlds.types import Array


@kernel
def activate(sizes: Sizes, interface: Array, write_heads: Array, read_heads: Array) -> None:
    """Heads get their controls: strengths by softplus, gates and erase vectors by sigmoid, modes by softmax."""
    word, _, readers, writers, _, alone, _ = sizes
    lay(interface[:, : len(write_heads)], write_heads, alone)
    lay(interface[:, len(write_heads) :], read_heads, alone)
    size = head_size(write_heads, writers)
    for i in range(writers):
        head = write_heads[i * size : (i + 1) * size]
        put(head, word, softplus(at(head, word)))
        for k in range(2 * word + 1, size):
            put(head, k, sigmoid(at(head, k)))
    size = head_size(read_heads, readers)
    for j in range(readers):
        head = read_heads[j * size : (j + 1) * size]
        put(head, word, softplus(at(head, word)))
        put(head, word + 1, sigmoid(at(head, word + 1)))
        softmax(head[word + 2 :], 0)


@fused
def activate_back(
    sizes: Sizes, write_heads: Array, read_heads: Array, d_write_heads: Array, d_read_heads: Array, d_interface: Array
) -> None:
    """Back through `activate`."""
    word, _, readers, writers, _, alone, _ = sizes
    size = head_size(write_heads, writers)
    for i in range(writers):
        head, d_head = write_heads[i * size : (i + 1) * size], d_write_heads[i * size : (i + 1) * size]
        put(d_head, word, at(d_head, word) * (1 - decay(at(head, word))))
        for k in range(2 * word + 1, size):
            put(d_head, k, at(d_head, k) * at(head, k) * (1 - at(head, k)))
    size = head_size(read_heads, readers)
    for j in range(readers):
        head, d_head = read_heads[j * size : (j + 1) * size], d_read_heads[j * size : (j + 1) * size]
        free = at(head, word + 1)
        put(d_head, word, at(d_head, word) * (1 - decay(at(head, word))))
        put(d_head, word + 1, at(d_head, word + 1) * free * (1 - free))
        softmax_back(head[word + 2 :], d_head[word + 2 :], 0)
    unlay(d_write_heads, d_interface[:, : len(d_write_heads)], alone)
    unlay(d_read_heads, d_interface[:, len(d_write_heads) :], alone)
