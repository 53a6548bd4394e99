"""How the states of a batch lie for the fast memory access: side by side.

A state is two buffers, the links and all the rest, with a row for each number of a state and the samples in columns.
The parts that others see are views of them, with the batch first. What comes back as such views, a state or a gradient
of one, is used where it lies, at once if it remembers its buffers; anything else is copied.
"""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import accumulate
from math import prod
from typing import NamedTuple

from torch import Tensor

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.dnc.job import tape_sizes
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.room import room


class Buffers(NamedTuple):
    """A state of a batch, or a gradient by one."""

    rest: Tensor
    """[rows, pitch], all but the links."""
    links: Tensor
    """[K * N * N, pitch]"""


class Packed(AccessState[Tensor]):
    """A state that remembers what its parts are views of."""

    layout: "Layout | None" = None
    buffers: Buffers


class View(NamedTuple):
    """How a part lies in its buffer."""

    shape: tuple[int, ...]
    strides: tuple[int, ...]
    offset: int


class Layout(NamedTuple):
    """How the states of a batch lie."""

    sizes: tuple[int, ...]
    """The first numbers of a job."""
    blocks: int
    """Of 16 samples."""
    rest: tuple[int, int]
    links: tuple[int, int]
    tape: tuple[int, int]
    """The buffers' sizes."""
    reads: tuple[int, ...]
    """[..., R, D]"""
    parts: AccessState[View]

    def empty(self, like: Tensor) -> Buffers:
        """Room for a state."""
        return Buffers(like.new_empty(self.rest), room(like, self.links))

    def packed(self, parts: Iterable[Tensor], buffers: Buffers) -> Packed:
        """The state of which these are the parts and the buffers."""
        state = Packed(*parts)
        state.layout, state.buffers = self, buffers
        return state

    def views(self, buffers: Buffers) -> AccessState[Tensor]:
        """The parts of a state."""
        rest, links, parts = *buffers, self.parts
        return AccessState(
            rest.as_strided(*parts.memory), rest.as_strided(*parts.read_weights), rest.as_strided(*parts.write_weights),
            rest.as_strided(*parts.usage), links.as_strided(*parts.links), rest.as_strided(*parts.precedence),
        )  # fmt: skip

    def buffers(self, state: AccessState[Tensor]) -> Buffers:
        """The buffers that a state lies in, or copies."""
        if isinstance(state, Packed) and state.layout is self:
            return state.buffers
        *rest, links, precedence = state
        *places, place, last = self.parts
        return Buffers(_buffer([*rest, precedence], [*places, last], self.rest), _buffer([links], [place], self.links))


def _buffer(parts: Sequence[Tensor], places: Sequence[View], size: tuple[int, int]) -> Tensor:
    """What the parts are views of, or a copy."""
    first = parts[0].detach()
    start, width = first.data_ptr(), first.element_size()
    for part, (_, strides, offset) in zip(parts, places, strict=True):
        if part.numel() and (part.data_ptr() != start + offset * width or part.stride() != strides):
            break
    else:
        return first.as_strided(size, (size[1], 1))
    buffer = first.new_zeros(size)
    for part, place in zip(parts, places, strict=True):
        buffer.as_strided(*place).copy_(part.detach())
    return buffer


@lru_cache
def layout(heads: Heads, rows: int, batch: tuple[int, ...]) -> Layout:
    """The layout for batches of one size, or for single samples.

    From row to row it is an odd number of blocks, as with a power of two all rows would want the same few places of the
    processor's cache.
    """
    blocks = -(-prod(batch) // LANES)
    pitch = LANES * (blocks | 1) if blocks else 0
    views, ends, filled = [], [], {True: 0, False: 0}
    for name, shape in zip(AccessState._fields, heads.state_shapes(rows), strict=True):
        own = name == "links"
        strides = tuple(pitch * prod(shape[axis + 1 :]) for axis in range(len(shape)))
        views.append(View((*batch, *shape), (1,) * len(batch) + strides, pitch * filled[own]))
        filled[own] += prod(shape)
        ends.append(filled[own])
    ends.extend(accumulate(tape_sizes(heads, rows)))
    sizes = prod(batch), pitch, heads.interface, heads.word, rows, heads.reads, heads.writes, heads.linked, *ends
    reads = *batch, heads.reads, heads.word
    buffers = (filled[False], pitch), (filled[True], pitch), (ends[-1], pitch)
    return Layout(sizes, blocks, *buffers, reads, AccessState(*views))
