"""The memory access of a differentiable neural computer on the CPU, forward and backward.

The links are most of what the backward pass needs, and they follow from the write weightings. So they may be kept every
few steps only, and be worked out again in between.
"""

from typing import Any

import torch
from torch import Tensor
from torch.autograd import Function
from torch.autograd.function import once_differentiable

from fogbench.learned.dnc.access import AccessState
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.dnc.layout import Buffers, Layout, layout
from fogbench.learned.dnc.step import BACKWARD, FORWARD, RELINK


def fast_access(
    heads: Heads, interface: Tensor, state: AccessState[Tensor], every: int = 1
) -> tuple[Tensor, AccessState[Tensor]]:
    """What `access` gives for the controls in an interface vector [..., I], by loops of our own.

    Args:
        heads: the sizes.
        interface: [B, I] or [I], float32 or float64 on the CPU.
        state: the state before, of the same type.
        every: keep the links for the backward pass at every so many steps; 1 keeps them all.
    """
    lies = layout(heads, state.usage.shape[-1], interface.shape[:-1])
    old = lies.buffers(state)
    if torch.is_grad_enabled() and (interface.requires_grad or any(part.requires_grad for part in state)):
        new, reads, *after = _Step.apply(lies, every, old, interface, *state)  # type: ignore[no-untyped-call]  # torch's
        return reads, lies.packed(after, new)
    new, reads, _ = _step(lies, old, interface)
    return reads, lies.packed(lies.views(new), new)


def _step(lies: Layout, old: Buffers, interface: Tensor) -> tuple[Buffers, Tensor, Tensor]:
    """The state after, the reads, and the tape."""
    new, reads, tape = lies.empty(interface), interface.new_empty(lies.reads), interface.new_empty(lies.tape)
    interface = interface.contiguous()
    FORWARD.run(tape.dtype, lies.blocks, lies.sizes, (interface, *old, *new, reads, tape))
    return new, reads, tape


ARGUMENTS, LINKS = 4, AccessState._fields.index("links")
"""Of a step before the state, and of the state before the links."""


class _Step(Function):
    """One step of a batch. What the way back needs stays on `ctx`, the step's node in torch's graph."""

    @staticmethod
    def forward(ctx: Any, lies: Layout, every: int, old: Buffers, interface: Tensor, *state: Tensor) -> tuple[Any, ...]:
        """The buffers of the state after, which are no part of the graph, the reads and the state after."""
        new, reads, tape = _step(lies, old, interface)
        ctx.layout, ctx.old, ctx.new, ctx.tape, ctx.interface = lies, old.rest, new.rest, tape, interface.shape
        ctx.set_materialize_grads(False)
        keep_links(ctx, old.links, state[LINKS].grad_fn, every)
        return new, reads, *lies.views(new)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, _: None, d_reads: Tensor | None, *d_state: Tensor | None) -> tuple[Tensor | None, ...]:
        """The gradients by the interface and the state before; zeros by past write weightings."""
        lies, links = ctx.layout, links_before(ctx)
        d_reads = ctx.tape.new_zeros(lies.reads) if d_reads is None else d_reads.contiguous()
        d_new = lies.gradients(AccessState(*d_state), d_reads)
        d_old = lies.empty(d_reads, links=ctx.needs_input_grad[ARGUMENTS + LINKS])
        d_interface = d_reads.new_empty(ctx.interface)
        tensors = None, ctx.old, links, ctx.new, None, None, ctx.tape, d_reads, *d_new, *d_old, d_interface
        BACKWARD.run(d_reads.dtype, lies.blocks, lies.sizes, tensors)
        forget_links(ctx)
        return None, None, None, d_interface, *lies.views(d_old)


def keep_links(step: Any, links: Tensor | None, before: Any, every: int) -> None:
    """Let a step keep the links before it, or the step before, if that came from here and not `every` steps passed."""
    follows = type(before) is type(step)
    step.age = (before.age + 1) % every if follows else 0
    step.links, step.previous = (None, before) if step.age else (links, None)


def links_before(step: Any) -> Tensor:
    """The links before a step, for which the steps since the links were last kept are linked again."""
    if step.links is None:
        before, links_then = step.previous, links_before(step.previous)
        step.links = links_then.new_empty(links_then.shape)
        tensors = None, before.old, links_then, before.new, step.links
        RELINK.run(links_then.dtype, step.layout.blocks, step.layout.sizes, tensors)
    links: Tensor = step.links
    return links


def forget_links(step: Any) -> None:
    """Free links that were worked out again."""
    if step.previous is not None:
        step.links = None
