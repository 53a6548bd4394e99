"""How the states of a batch lie for the fast memory access: sixteen numbers side by side, of samples or of rows.

A state is two buffers, the links and all the rest. With few rows it has a row for each number of a state and the
samples in columns; with many, one sample after the other, its memory rows side by side. The parts that others see are
views of them, with the batch first. What comes back as such views, a state or a gradient of one, is used where it lies,
at once if it remembers its buffers; anything else is copied.
"""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import accumulate
from math import prod
from typing import Any, NamedTuple

from torch import Tensor

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.dnc.job import tape_sizes
from fogbench.learned.kernels.lanes import LANES
from fogbench.learned.kernels.room import room
from fogbench.learned.shapes import Shape

MANY = {True: 80, False: 512}
"""Rows, with and without all links, from which those of one sample fill the lanes better than sixteen samples do."""


class Buffers(NamedTuple):
    """A state of a batch, or a gradient by one."""

    rest: Tensor
    """[any, pitch], all but the links."""
    links: Tensor | None
    """[any, pitch]; None: all zeros, of a gradient."""


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
    """Of 16 samples, or of one."""
    rest: tuple[int, int]
    links: tuple[int, int]
    tape: tuple[int, int]
    """The buffers' sizes."""
    reads: tuple[int, ...]
    """[..., R, D]"""
    parts: AccessState[View]

    def empty(self, like: Tensor, *, links: bool = True) -> Buffers:
        """Room for a state."""
        return Buffers(like.new_empty(self.rest), room(like, self.links) if links else None)

    def packed(self, parts: Iterable[Tensor], buffers: Buffers) -> Packed:
        """The state of which these are the parts and the buffers."""
        state = Packed(*parts)
        state.layout, state.buffers = self, buffers
        return state

    def views(self, buffers: Buffers) -> AccessState[Any]:
        """The parts of a state: tensors, and None for links that have no room."""
        rest, links, parts = *buffers, self.parts
        whole = links if links is None else links.as_strided(*parts.links)
        return AccessState(
            rest.as_strided(*parts.memory), rest.as_strided(*parts.read_weights), rest.as_strided(*parts.write_weights),
            rest.as_strided(*parts.usage), whole, rest.as_strided(*parts.precedence),
        )  # fmt: skip

    def buffers(self, state: AccessState[Any]) -> Buffers:
        """The buffers that a state lies in, or copies."""
        if isinstance(state, Packed) and state.layout is self:
            return state.buffers
        *rest, links, precedence = state
        *places, place, last = self.parts
        whole = links if links is None else _buffer([links], [place], self.links)
        return Buffers(_buffer([*rest, precedence], [*places, last], self.rest), whole)

    def gradients(self, state: AccessState[Tensor | None], like: Tensor) -> Buffers:
        """The same of gradients by a state; where one is missing there are zeros, or no links."""
        if not any(part is None for part in state):
            return self.buffers(state)
        zero = like.new_zeros(())
        parts = (
            zero.expand(view.shape) if part is None else part for part, view in zip(state, self.parts, strict=True)
        )
        whole: AccessState[Tensor | None] = AccessState(*parts)
        return self.buffers(whole._replace(links=state.links))


def _buffer(parts: Sequence[Tensor], places: Sequence[View], size: tuple[int, int]) -> Tensor:
    """What the parts are views of, or a copy."""
    first = parts[0].detach()
    start, width = first.data_ptr(), first.element_size()
    whole = first.untyped_storage().nbytes() == width * prod(size)  # what lies between the parts is ours
    for part, (_, strides, offset) in zip(parts, places, strict=True):
        if part.numel() and not (whole and part.data_ptr() == start + offset * width and part.stride() == strides):
            break
    else:
        return first.as_strided(size, (size[1], 1))
    buffer = first.new_zeros(size)
    for part, place in zip(parts, places, strict=True):
        buffer.as_strided(*place).copy_(part.detach())
    return buffer


def layout(heads: Heads, rows: int, batch: tuple[int, ...]) -> Layout:
    """The layout for batches of one size: sixteen samples side by side, or the many rows of each."""
    return arranged(heads, rows, batch, 1 if rows < MANY[heads.links and not heads.kept] else LANES)


@lru_cache
def arranged(heads: Heads, rows: int, batch: tuple[int, ...], side: int) -> Layout:
    """The layout in which so many rows of a sample lie side by side: one, so that samples can, or 16.

    Where samples are side by side it is an odd number of blocks from row to row, as with a power of two all rows would
    want the same few places of the processor's cache.
    """
    count, alone, whole = prod(batch), side > 1, -(-rows // side) * side
    blocks = -(-count * side // LANES)
    pitch = LANES if alone else LANES * (blocks | 1) if blocks else 0
    apart, times = (1, count) if alone else (pitch, 1)
    places, ends, (rest, links) = _places(heads.state_shapes(rows, whole))
    shapes = zip(heads.state_shapes(rows), places, strict=True)
    views = [_view(batch, shape, place, apart, alone) for shape, place in shapes]
    ends = [end // side for end in ends] + list(accumulate(tape_sizes(heads, whole // side)))
    single = rows if alone else 0
    counts = heads.word, whole // side, heads.reads, heads.writes, heads.linked, single, heads.strongest(rows)
    reads = *batch, heads.reads, heads.word
    return Layout(
        (count, pitch, heads.interface, *counts, *ends), blocks, (times * rest // side, pitch),
        (times * links // side, pitch), (times * ends[-1], pitch), reads, AccessState(*views),
    )  # fmt: skip


class Place(NamedTuple):
    """Where the numbers of a sample are in a buffer that has no other sample."""

    shape: Shape
    first: int
    size: int
    """Of the buffer."""


def _places(shapes: Sequence[Shape]) -> tuple[list[Place], list[int], tuple[int, int]]:
    """The places of parts of some shapes, where they end, and the sizes of the buffers for the rest and the links."""
    own = AccessState._fields.index("links")
    rest = list(accumulate(0 if k == own else prod(shape) for k, shape in enumerate(shapes)))
    links = prod(shapes[own])
    ends = [links if k == own else end for k, end in enumerate(rest)]
    sizes = [links if k == own else rest[-1] for k in range(len(shapes))]
    places = [Place(shape, end - prod(shape), size) for shape, end, size in zip(shapes, ends, sizes, strict=True)]
    return places, ends, (rest[-1], links)


def _view(batch: tuple[int, ...], shape: Shape, place: Place, apart: int, alone: bool) -> View:
    """A part of a batch, whose numbers are so far apart."""
    between = place.size if alone else 1
    strides = tuple(apart * prod(place.shape[axis + 1 :]) for axis in range(len(place.shape)))
    return View((*batch, *shape), (between,) * len(batch) + strides, apart * place.first)
