"""From what agents know of graphs to what a network sees; one implementation for single decisions and for batches.

Words used here
    B        samples
    P, E, K  nodes, links and neighbours of the agents' nodes, of all samples, one sample after the other
"""

from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.encoding.explored_sizes import FRONTIER, TOLD, TRAITS
from fogbench.worlds.graph.known import NONE
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array


class Explored(NamedTuple):
    """What some agents know at one step, one after the other; numbers of nodes and links are those in each graph."""

    nodes: Array
    """[B + 1] int64, where the nodes of each begin among all P."""
    links: Array
    """[B + 1] int64, the same of links."""
    heads: Array
    """[P] int32"""
    following: Array
    """[E, 2] int32"""
    lengths: Array
    """[E] float64, in mean lengths of the edges that the agent knows."""
    visited: Array
    """[P] bool"""
    straight: Array
    """[P] float64, the straight line to the goal in the same unit; infinite where that is not known."""
    places: Array
    """[B] int64"""
    before: Array
    """[B] int64, where the agents came from; NONE at first."""
    goals: Array
    """[B] int64"""
    blocked: Array
    """[B] bool"""


class ExploredInputs(NamedTuple):
    """What a network sees, for a batch."""

    nodes: Tensor
    """[B + 1] int64, as in `Explored`, and so are the next four."""
    links: Tensor
    heads: Tensor
    following: Tensor
    lengths: Tensor
    is_end: Tensor
    """[P] bool, nodes that were seen and not visited."""
    frontier: Tensor
    """[P, FRONTIER] float32"""
    owners: Tensor
    """[K] int64, the samples that neighbours belong to."""
    neighbours: Tensor
    """[K] int64, their numbers among all P."""
    steps: Tensor
    """[K] float32, how long the edges to them are."""
    traits: Tensor
    """[K, TRAITS] float32"""
    told: Tensor
    """[B, TOLD] float32"""

    @property
    def image(self) -> Tensor:
        """[B, TOLD], the agents' nodes."""
        return self.told

    def to(self, device: str) -> "ExploredInputs":
        """The same on a device."""
        return self if self.told.device.type == device else ExploredInputs(*(part.to(device) for part in self))


def encode(known: Explored) -> ExploredInputs:
    """What a network sees of what some agents know."""
    degrees, is_end = np.zeros(len(known.heads), np.int64), np.zeros(len(known.heads), np.bool_)
    frontier = np.zeros((len(known.heads), FRONTIER), np.float32)
    told = np.zeros((len(known.places), TOLD), np.float32)
    count = survey(known, degrees, is_end, frontier, told)
    owners, neighbours = np.empty(count, np.int64), np.empty(count, np.int64)
    steps, traits = np.empty(count, np.float32), np.zeros((count, TRAITS), np.float32)
    look_around(known, degrees, owners, neighbours, steps, traits)
    arrays = *known[:5], is_end, frontier, owners, neighbours, steps, traits, told
    return ExploredInputs(*map(torch.from_numpy, arrays))


@kernel
def survey(known: Explored, degrees: Array, is_end: Array, frontier: Array, told: Array) -> int:
    """Fill what is said of nodes, and of the agents' own, into zeros; returns K."""
    neighbours = 0
    for b in range(len(known.places)):
        first, edge, goal = known.nodes[b], known.links[b], known.nodes[b] + known.goals[b]
        for node in range(first, known.nodes[b + 1]):
            link = known.heads[node]
            while link != NONE:
                degrees[node] += 1
                link = known.following[edge + link, 0]
            is_end[node] = degrees[node] > 0 and not known.visited[node]
            frontier[node, 0] = node == goal
            frontier[node, 1] = np.log1p(degrees[node])
            frontier[node, 2] = np.exp(-known.straight[node] / 4)
        place = first + known.places[b]
        neighbours += degrees[place]
        link = known.heads[place]
        while link != NONE:
            told[b, 1] += not known.visited[first + known.following[edge + link, 1]]
            link = known.following[edge + link, 0]
        told[b, 0], told[b, 1] = np.log1p(degrees[place]), np.log1p(told[b, 1])
        told[b, 2], told[b, 3] = is_end[goal], known.blocked[b]
    return neighbours


@kernel
def look_around(
    known: Explored, degrees: Array, owners: Array, neighbours: Array, steps: Array, traits: Array
) -> None:  # fmt: skip
    """Fill what is said of neighbours, in the order of their links."""
    k = 0
    for b in range(len(known.places)):
        first, edge = known.nodes[b], known.links[b]
        link = known.heads[first + known.places[b]]
        while link != NONE:
            other = known.following[edge + link, 1]
            owners[k], neighbours[k], steps[k] = b, first + other, known.lengths[edge + link]
            traits[k, 0], traits[k, 1] = other == known.goals[b], known.visited[first + other]
            traits[k, 2], traits[k, 3] = other == known.before[b], np.log1p(degrees[first + other])
            k += 1
            link = known.following[edge + link, 0]
