"""Many graphs in one call: the episodes of `GraphWorld`, as arrays, by its own kernels.

Words used here
    B, n     slots, and those that a call is about
    N        nodes of the largest graph so far; of a smaller one only its own count
    E        room for the edges of one graph, each from both ends
    C        columns of a view, see `fogbench.worlds.graph.world`; the most of any graph so far
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fogbench.worlds.batch import Luck, Steps
from fogbench.worlds.graph.world import length_of, look
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array, Observation

if TYPE_CHECKING:
    from fogbench.worlds.graph.world import GraphWorld


@dataclass(frozen=True, eq=False)
class GraphObservations(Sequence[Observation]):
    """What n agents are told, as arrays, and one by one."""

    steps: Array
    """[n] int64"""
    places: Array
    """[n] int64"""
    views: Array
    """[n, N, C] float64, read-only"""
    blocked: Array
    """[n] bool"""
    shapes: Array
    """[n, 2] int64, N and C of each one's own view"""

    def __len__(self) -> int:
        """How many they are."""
        return len(self.places)

    def __getitem__(self, k: Any) -> Any:
        """That of one agent."""
        size, columns = self.shapes[k]
        view = self.views[k, :size, :columns]
        return Observation(int(self.steps[k]), int(self.places[k]), view, bool(self.blocked[k]))


class GraphBatch:
    """Graph worlds side by side."""

    def __init__(self, slots: int) -> None:
        """No episode yet."""
        self.starts = np.zeros((slots, 1), np.int32)  # [B, N + 1]
        self.ends = np.zeros((slots, 0), np.int32)  # [B, E]
        self.lengths = np.zeros((slots, 0))  # [B, E]
        self.coordinates = np.full((slots, 0, 2), np.inf)  # [B, N, 2]
        self.shapes = np.ones((slots, 2), np.int64)
        self.places, self.goals, self.steps, self.budgets = (np.zeros(slots, np.int64) for _ in range(4))
        self.blocked, self.slip = np.zeros(slots, np.bool_), np.zeros(slots)
        self.lucks: list[Any] = [None] * slots

    def reset(self, slots: Array, worlds: Sequence["GraphWorld"], lucks: Sequence[Luck]) -> None:
        """Put fresh episodes into some slots."""
        self._make_room(max(world.graph.size for world in worlds), max(len(world.graph.ends) for world in worlds))
        self.steps[slots], self.blocked[slots] = 0, False
        self.places[slots] = [world.start for world in worlds]
        self.goals[slots] = [world.task.goal for world in worlds]
        self.budgets[slots] = [world.task.budget.steps for world in worlds]
        self.slip[slots] = [world.slip for world in worlds]
        self.shapes[slots] = [(world.graph.size, 1 + world.graph.coordinates.shape[1]) for world in worlds]
        for slot, world, luck in zip(slots.tolist(), worlds, lucks, strict=True):
            graph = world.graph
            self.starts[slot, : graph.size + 1] = graph.starts
            self.ends[slot, : len(graph.ends)], self.lengths[slot, : len(graph.ends)] = graph.ends, graph.lengths
            if graph.coordinates.size:
                self.coordinates[slot, : graph.size] = graph.coordinates
            self.lucks[slot] = luck() if world.slip else None

    def sense(self, slots: Array) -> GraphObservations:
        """What the agents there are told."""
        shapes, places = self.shapes[slots], self.places[slots]
        columns = int(shapes[:, 1].max())
        views = np.full((len(slots), self.starts.shape[1] - 1, columns), np.inf)
        look_each(slots, self.starts, self.ends, self.lengths, self.coordinates, shapes, places, self.goals, views)
        views.setflags(write=False)
        return GraphObservations(self.steps[slots], places, views[:], self.blocked[slots], shapes)

    def step(self, slots: Array, actions: Sequence[Any] | Array) -> Steps:
        """Go to neighbours, or stay.

        Raises:
            TypeError: an action is no node.
        """
        nodes = np.array(actions, np.int64)  # [n]
        if ((nodes < 0) | (nodes >= self.shapes[slots, 0])).any():
            raise TypeError(f"got the nodes {sorted(set(nodes.tolist()))}; expected those of the graphs, from 0")
        slipped = np.zeros(len(slots), np.bool_)
        for k in np.flatnonzero(self.slip[slots]).tolist():
            slipped[k] = self.lucks[slots[k]].random() < self.slip[slots[k]]
        lengths = np.zeros(len(slots))
        go_each(slots, self.starts, self.ends, self.lengths, nodes, slipped, self.places, self.blocked, lengths)
        self.steps[slots] += 1
        reached = self.places[slots] == self.goals[slots]
        return Steps(lengths, np.zeros_like(slipped), reached, self.steps[slots] >= self.budgets[slots])

    def _make_room(self, size: int, ends: int) -> None:
        self.starts = widened(self.starts, size + 1)
        self.ends, self.lengths = (widened(array, ends) for array in (self.ends, self.lengths))
        self.coordinates = widened(self.coordinates, size)


def widened(arrays: Array, width: int) -> Array:
    """Arrays [B, any, ...] with room for `width` in each."""
    more = width - arrays.shape[1]
    return np.pad(arrays, [(0, 0), (0, more), *[(0, 0)] * (arrays.ndim - 2)]) if more > 0 else arrays


@kernel
def look_each(
    slots: Array, starts: Array, ends: Array, lengths: Array, coordinates: Array,
    shapes: Array, places: Array, goals: Array, views: Array,
) -> None:  # fmt: skip
    """Write what is seen from `places` [n] into views of which all is infinite."""
    for k in range(len(slots)):
        slot, size, columns = slots[k], shapes[k, 0], shapes[k, 1]
        own, told = views[k, :size, :columns], coordinates[slot, :, : columns - 1]
        look(starts[slot], ends[slot], lengths[slot], told, places[k], goals[slot], own)


@kernel
def go_each(
    slots: Array, starts: Array, ends: Array, lengths: Array, nodes: Array, slipped: Array,
    places: Array, blocked: Array, gone: Array,
) -> None:  # fmt: skip
    """Move the agents of some slots to neighbours; `gone` [n] is how far."""
    for k in range(len(slots)):
        slot = slots[k]
        length = length_of(starts[slot], ends[slot], lengths[slot], places[slot], nodes[k])
        blocked[slot] = length == np.inf
        if not blocked[slot] and not slipped[k]:
            places[slot], gone[k] = nodes[k], length
