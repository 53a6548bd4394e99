"""The ledger: what an agent says it carries from one decision to the next is what it holds."""

from collections import deque
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import torch

from fogbench.learned.dnc.layout import Buffers
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import AgentSettings, Task, World

NOT_CARRIED = (Settings, Task, np.random.Generator, torch.nn.Module, Buffers, type)
"""What an agent was given when it started, the weights it shares with all others of its settings, its classes, and the
room that the parts of a DNC's state are views of: that is padded for sixteen samples, and the parts are counted."""

ARRAYS = (np.ndarray, torch.Tensor)

CONTAINERS = (list, tuple, dict, set, frozenset, deque)


def held(root: Any) -> Iterator[Any]:
    """All objects that can be reached from an agent through attributes and containers, each once."""
    seen, waiting = set(), [root]
    while waiting:
        thing = waiting.pop()
        if id(thing) in seen or isinstance(thing, NOT_CARRIED):
            continue
        seen.add(id(thing))
        yield thing
        waiting += parts(thing)


def parts(thing: Any) -> list[Any]:
    """What an object holds; an array's elements are not objects, and its base is not its own."""
    found = list(getattr(thing, "__dict__", {}).values())
    slots = (slot for cls in type(thing).__mro__ for slot in np.atleast_1d(getattr(cls, "__slots__", ())).tolist())
    found += [getattr(thing, slot) for slot in slots if hasattr(thing, slot)]
    if isinstance(thing, dict):
        found += [*thing, *thing.values()]
    elif isinstance(thing, CONTAINERS):
        found += thing
    return found


def test_memory_is_what_is_held(agent: AgentSettings, meetings: list[World], play: Callable[..., Any]) -> None:
    """After every decision `memory_bytes` is the sum of all arrays and tensors held; no container grows beside them."""
    for seed, world in enumerate(meetings):
        sizes = set()
        for decision in play(world, agent, seed):
            everything = list(held(decision.agent))
            arrays = [thing for thing in everything if isinstance(thing, ARRAYS)]
            assert decision.memory_bytes == sum(array.nbytes for array in arrays)
            assert not any(isinstance(array, np.ndarray) and array.dtype.hasobject for array in arrays)
            sizes.add(sum(len(thing) for thing in everything if isinstance(thing, CONTAINERS)))
        assert len(sizes) == 1


def test_nothing_leads_to_the_truth(agent: AgentSettings, meetings: list[World], play: Callable[..., Any]) -> None:
    """Neither what an agent is told nor anything it holds leads to the world or to its map."""
    for seed, world in enumerate(meetings):
        truth = [thing for thing in held(world) if isinstance(thing, np.ndarray)]
        assert truth
        for decision in play(world, agent, seed):
            told = [*world.task, *decision.observation, decision.agent]
            for thing in (thing for each in told for thing in held(each)):
                assert not hasattr(thing, "shortest"), f"{thing!r} is a world"
                if isinstance(thing, np.ndarray):
                    assert not any(np.shares_memory(thing, each) for each in truth)
