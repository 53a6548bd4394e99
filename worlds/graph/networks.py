"""Graphs of networkx, as its generators make them and its readers read them, as ours."""

from typing import Any, NamedTuple

import numpy as np

from fogbench.worlds.graph.distances import FAR, hops
from fogbench.worlds.graph.graph import EDGES, NODES, Graph, joined
from fogbench.worlds.mistake import Mistake, shown
from fogbench.worlds.types import Array

LENGTHS = ("length", "weight")
"""Attributes of an edge that say how long it is; the first that all edges have counts."""

RADIUS = 6_371_009.0
"""Of the earth [m], as osmnx has it."""

SLACK = 1e-3
"""By which share an edge may be shorter than the straight line, whose ends are rounded."""


class Converted(NamedTuple):
    """A graph, and what its nodes are called where it comes from."""

    graph: Graph
    names: list[Any]


def converted(source: Any) -> Converted:
    """A graph of networkx, with its nodes in their order there.

    Loops are left out; of several edges between two nodes, the shortest counts. Edges without a length are as long as
    the straight line between their nodes, or 1 where nodes have no coordinates.

    Raises:
        Mistake: it has too many nodes or edges, or numbers that cannot be.
    """
    names = list(source)
    for count, noun, most in ((len(names), "node", NODES), (source.number_of_edges(), "edge", EDGES)):
        if count > most:
            raise Mistake(f"got {count:,} {noun}s; expected at most {most:,}")
    number = {name: k for k, name in enumerate(names)}
    ends = np.array([sorted((number[a], number[b])) for a, b in source.edges()], np.int32).reshape(-1, 2)
    places, told = coordinates(source, names), lengths(source)
    straight = np.sqrt(np.square(places[ends[:, 0]] - places[ends[:, 1]]).sum(1)) if places is not None else None
    if told is None:
        told = np.ones(len(ends)) if straight is None else straight
    kept = shortest_of_each(ends, told)
    ends, told = ends[kept], told[kept]
    refuse_short(names, ends, told, np.zeros(len(ends)) if straight is None else straight[kept])
    return Converted(joined(len(names), ends, told, places), names)


def shortest_of_each(ends: Array, told: Array) -> Array:
    """Which of some edges [M, 2] with lengths [M] count: no loop, and the shortest between any two nodes: [n] int."""
    order = np.lexsort((told, ends[:, 1], ends[:, 0]))
    order = order[ends[order, 0] != ends[order, 1]]
    first = np.ones(len(order), np.bool_)
    first[1:] = (ends[order[1:]] != ends[order[:-1]]).any(1)
    kept: Array = order[first]
    return kept


def lengths(source: Any) -> Array | None:
    """How long the edges are, in their order: [M] float64; None where they do not all say.

    Raises:
        Mistake: one of them says no number.
    """
    for name in LENGTHS:
        values = [attributes.get(name) for _, _, attributes in source.edges(data=True)]
        if values and None not in values:
            return np.array([number(value, f"an edge's {name}") for value in values])
    return None


def coordinates(source: Any, names: list[Any]) -> Array | None:
    """Where the nodes are: [N, 2] float64 of x and y; None where they do not all say.

    They say it by `x` and `y`, by `pos`, or by a name that is a pair of numbers. Degrees, which a graph says by `crs:
    epsg:4326` as osmnx writes them, become metres on the plane that touches the earth in the middle of them.

    Raises:
        Mistake: one of them says no number.
    """
    attributes = [source.nodes[name] for name in names]
    if all({"x", "y"} <= each.keys() for each in attributes):
        pairs = [(each["x"], each["y"]) for each in attributes]
    else:
        pairs = [each.get("pos", name) for each, name in zip(attributes, names, strict=True)]
    if not pairs or not all(isinstance(pair, tuple | list) and len(pair) == 2 for pair in pairs):
        return None
    found = np.array([[number(part, "a node's coordinate") for part in pair] for pair in pairs])
    if str(source.graph.get("crs", "")).lower() == "epsg:4326":
        scale = np.cos(np.deg2rad(found[:, 1].mean())), 1.0
        found = np.deg2rad(found - found.mean(0)) * scale * RADIUS
    return found


def number(value: Any, what: str) -> float:
    """A number as a file has it.

    Raises:
        Mistake: it is none, or has no end.
    """
    try:
        found = float(value)
    except (TypeError, ValueError):
        found = np.nan
    if not np.isfinite(found):
        raise Mistake(f"got {shown(str(value))} as {what}; expected a number")
    return found


def refuse_short(names: list[Any], ends: Array, told: Array, straight: Array) -> None:
    """Hold lengths [M] against the straight lines [M] between their nodes, 0 where nodes are nowhere.

    Raises:
        Mistake: an edge has no length, or one is shorter, so that lengths and coordinates have different units.
    """
    for k in np.flatnonzero((told <= 0) | (told < straight * (1 - SLACK))).tolist():
        edge = " - ".join(shown(str(names[node])) for node in ends[k])
        line = f"at least the straight line of {straight[k]:g} between its nodes, in the same unit"
        expected = line if straight[k] else "a number above 0"
        raise Mistake(f"edge {edge}: got a length of {told[k]:g}; expected {expected}")


def parts(graph: Graph) -> int:
    """How many parts of a graph no edge joins."""
    rest, count = np.arange(graph.size), 0
    while len(rest):
        rest = rest[hops(graph.starts, graph.ends, rest[0])[rest] == FAR]
        count += 1
    return count
