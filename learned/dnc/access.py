"""The memory access of a differentiable neural computer, as its equations (Graves et al. 2016, Methods).

With several write heads the equations of google-deepmind/dnc hold: write weightings are allocated one after the other,
each write head has its own temporal links, and the modes of a read head are backward (W), forward (W), content.

Words used here
    R, W  read and write heads
    N     memory rows
    D     numbers in a row, the memory's word
    K     heads with temporal links: W, or 0 without links, which leaves one read mode
    S     links that a row keeps, the strongest, where it does not keep all (Rae et al. 2016)
    ...   a batch [B], or nothing for a single sample

All arrays of rows have the rows last, the memory too: [..., D, N].
"""

from math import prod
from typing import Generic, NamedTuple, TypeVar

import torch
from torch import Tensor
from torch.nn.functional import softplus

from fogbench.learned.dnc.heads import Heads

EPSILON = 1e-6
"""Keeps usages from zero, and norms and their products."""

T = TypeVar("T")


class AccessState(NamedTuple, Generic[T]):
    """What the memory access carries from one step to the next, as tensors or as arrays."""

    memory: T
    """[..., D, N]"""
    read_weights: T
    """[..., R, N]"""
    write_weights: T
    """[..., W, N]"""
    usage: T
    """[..., N]"""
    links: T
    """[..., K, N, N], at (n, m) how far row n was written next after row m.

    Or [..., K, 2 * S, N], of each row n its S strongest links, and after them the rows m that they lead to.
    """
    precedence: T
    """[..., K, N], how far a row was the last one written."""


class Controls(NamedTuple):
    """What the controller tells the memory access at one step."""

    write_keys: Tensor
    """[..., W, D]"""
    write_strengths: Tensor
    """[..., W] > 0"""
    values: Tensor
    """[..., W, D]"""
    erase: Tensor
    """[..., W, D] in (0, 1)"""
    allocation_gates: Tensor
    """[..., W] in (0, 1)"""
    write_gates: Tensor
    """[..., W] in (0, 1)"""
    read_keys: Tensor
    """[..., R, D]"""
    read_strengths: Tensor
    """[..., R] > 0"""
    free_gates: Tensor
    """[..., R] in (0, 1)"""
    read_modes: Tensor
    """[..., R, 2 * K + 1], distributions over backward links, forward links and content."""


def blank(heads: Heads, rows: int, batch: tuple[int, ...] = (), like: Tensor | None = None) -> AccessState[Tensor]:
    """The state before the first step, all zeros, with the type and device of `like`."""
    like = torch.empty(()) if like is None else like
    return AccessState(*(like.new_zeros(batch + shape) for shape in heads.state_shapes(rows)))


def controls(heads: Heads, interface: Tensor) -> Controls:
    """The controls in an interface vector [..., I], which has the write heads first, a head's numbers together."""
    lead, (writers, readers) = interface.shape[:-1], heads.interface_shapes
    write = interface[..., : prod(writers)].reshape(*lead, *writers)  # [..., W, 3 * D + 3]
    read = interface[..., prod(writers) :].reshape(*lead, *readers)  # [..., R, D + 2 * K + 3]
    word = heads.word
    key, strength, value, erase, allocation, gate = torch.split(write, [word, 1, word, word, 1, 1], -1)
    read_key, read_strength, free, modes = torch.split(read, [word, 1, 1, 2 * heads.linked + 1], -1)
    return Controls(
        key, softplus(strength)[..., 0], value, erase.sigmoid(),
        allocation.sigmoid()[..., 0], gate.sigmoid()[..., 0],
        read_key, softplus(read_strength)[..., 0], free.sigmoid()[..., 0], modes.softmax(-1),
    )  # fmt: skip


def access(controls: Controls, state: AccessState[Tensor], strongest: int = 0) -> tuple[Tensor, AccessState[Tensor]]:
    """One step: free and count usage, write, link, read.

    Args:
        controls: what the controller tells.
        state: the state before.
        strongest: S; 0: all links are kept.

    Returns:
        What was read [..., R, D], and the state after it.
    """
    used = usage(controls, state)
    write_weights = written(controls, state.memory, used)
    memory = write(controls, state.memory, write_weights)
    before = spread(state.links) if strongest else state.links
    links, precedence = link(before, state.precedence, write_weights)
    kept = keep(links, strongest) if strongest else links
    read_weights = read(controls, memory, spread(kept) if strongest else links, state.read_weights)
    reads = read_weights @ memory.mT  # [..., R, D]
    return reads, AccessState(memory, read_weights, write_weights, used, kept, precedence)


def usage(controls: Controls, state: AccessState[Tensor]) -> Tensor:
    """Rows written before are used, rows read before and freed are not: [..., N]. Past writes get no gradient."""
    unwritten = (1 - state.write_weights.detach()).prod(-2)  # [..., N]
    retained = (1 - controls.free_gates[..., None] * state.read_weights).prod(-2)  # [..., N]
    return (state.usage + (1 - state.usage) * (1 - unwritten)) * retained


def allocation(used: Tensor) -> Tensor:
    """The weighting [..., N] that prefers the rows least used; of equal rows the first."""
    ordered, order = (EPSILON + (1 - EPSILON) * used).sort(dim=-1, stable=True)
    products = torch.cat([torch.ones_like(ordered[..., :1]), ordered[..., :-1]], -1).cumprod(-1)
    return torch.zeros_like(used).scatter(-1, order, (1 - ordered) * products)


def content(keys: Tensor, strengths: Tensor, memory: Tensor) -> Tensor:
    """The weightings [..., heads, N] by cosine similarity of keys [..., heads, D] and rows."""
    key_norms = (keys.square().sum(-1, keepdim=True) + EPSILON).sqrt()  # [..., heads, 1]
    row_norms = (memory.square().sum(-2, keepdim=True) + EPSILON).sqrt()  # [..., 1, N]
    cosines = keys @ memory / (key_norms * row_norms + EPSILON)  # [..., heads, N]
    return (strengths[..., None] * cosines).softmax(-1)


def written(controls: Controls, memory: Tensor, used: Tensor) -> Tensor:
    """The write weightings [..., W, N]: a head sees as used what the heads before it are allocated."""
    similar = content(controls.write_keys, controls.write_strengths, memory)  # [..., W, N]
    weights = []
    for head in range(similar.shape[-2]):
        gate, allocate = controls.write_gates[..., head, None], controls.allocation_gates[..., head, None]
        free = allocation(used)
        used = used + (1 - used) * allocate * gate * free
        weights.append(gate * (allocate * free + (1 - allocate) * similar[..., head, :]))
    return torch.stack(weights, -2)


def write(controls: Controls, memory: Tensor, weights: Tensor) -> Tensor:
    """The memory [..., D, N] after all heads erased, then all added."""
    kept = (1 - controls.erase[..., None] * weights[..., None, :]).prod(-3)  # [..., W, D, N] -> [..., D, N]
    return memory * kept + controls.values.mT @ weights


def link(links: Tensor, precedence: Tensor, weights: Tensor) -> tuple[Tensor, Tensor]:
    """The links [..., K, N, N] and the precedence [..., K, N] after a write; without links both stay empty."""
    weights = weights[..., : links.shape[-3], :]  # [..., K, N]
    to, of = weights[..., :, None], weights[..., None, :]
    linked = (1 - to - of) * links + to * precedence[..., None, :]
    others = 1 - torch.eye(links.shape[-1], dtype=links.dtype, device=links.device)
    return linked * others, (1 - weights.sum(-1, keepdim=True)) * precedence + weights


def keep(links: Tensor, strongest: int) -> Tensor:
    """Of links [..., K, N, N] the strongest of each row, of equal ones the first: [..., K, 2 * S, N]."""
    ordered, order = links.sort(dim=-1, descending=True, stable=True)
    return torch.cat([ordered[..., :strongest], order[..., :strongest].to(links.dtype)], -1).mT


def spread(kept: Tensor) -> Tensor:
    """Undo `keep`; links that were not kept are zero."""
    links, columns = kept.mT.chunk(2, -1)  # [..., K, N, S]
    return links.new_zeros(*links.shape[:-1], links.shape[-2]).scatter_add(-1, columns.long(), links)


def read(controls: Controls, memory: Tensor, links: Tensor, before: Tensor) -> Tensor:
    """The read weightings [..., R, N]: backward and forward along the links from those before, or by content."""
    similar = content(controls.read_keys, controls.read_strengths, memory)
    forward = before[..., None, :, :] @ links.mT  # [..., K, R, N]
    backward = before[..., None, :, :] @ links
    ways = torch.cat([backward, forward, similar[..., None, :, :]], -3)  # [..., 2 * K + 1, R, N]
    return (controls.read_modes.mT[..., None] * ways).sum(-3)
