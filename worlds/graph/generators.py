"""Graphs that a function of networkx makes, by its name."""

import inspect
from collections.abc import Mapping
from functools import cache
from typing import Any

import networkx as nx
import numpy as np

from fogbench.worlds.graph.graph import Graph, joined
from fogbench.worlds.graph.networks import converted, parts
from fogbench.worlds.mistake import Mistake, near, shown
from fogbench.worlds.types import MapError

TRIES = 100
"""Graphs that are made until one is connected."""

OURS = {"seed", "create_using", "backend", "backend_kwargs"}
"""What a page does not tell a generator."""


@cache
def generators() -> dict[str, list[inspect.Parameter]]:
    """The functions of networkx that make graphs, with their parameters."""
    return {
        name: list(inspect.signature(made).parameters.values())
        for name, made in vars(nx).items()
        if callable(made) and getattr(made, "__module__", "").startswith("networkx.generators.")
    }


def refuse_unknown(name: str, given: Mapping[str, Any]) -> None:
    """Hold the name of a generator, and of its parameters, against networkx.

    Raises:
        Mistake: there is no such generator, or it is not told just these.
    """
    if name not in generators():
        raise Mistake(f"a function of networkx that makes a graph (it has no {shown(name)})", near(name, generators()))
    parameters = [each for each in generators()[name] if each.name not in OURS]
    known = [each.name for each in parameters]
    for odd in sorted({*given} - {*known}):
        raise Mistake(f"parameters of {name}: {', '.join(known)} (it has no {shown(odd)})", near(odd, known))
    lacking = [each.name for each in parameters if each.default is each.empty and each.name not in given]
    if lacking:
        raise Mistake(
            f"all parameters of {name} ({' and '.join(lacking)} {'is' if len(lacking) == 1 else 'are'} missing)"
        )


def generated(name: str, given: Mapping[str, Any], rng: np.random.Generator) -> Graph:
    """A connected graph of a generator, its nodes shuffled.

    Raises:
        MapError: it makes none.
    """
    told, drawn = dict(given), "seed" in {each.name for each in generators()[name]}
    for _ in range(TRIES if drawn else 1):
        if drawn:
            told["seed"] = int(rng.integers(2**31))
        graph = _one(name, told)
        if graph.size > 1 and parts(graph) == 1:
            return shuffled(graph, rng)
    expected = f"one that is, in {TRIES} tries" if drawn else "one that is"
    raise MapError(f"{name}: got graphs that are not connected, or of one node; expected {expected}")


def shuffled(graph: Graph, rng: np.random.Generator) -> Graph:
    """The same graph with other numbers for its nodes."""
    order = rng.permutation(graph.size).astype(np.int32)  # the number that each node gets
    once = np.repeat(np.arange(graph.size), np.diff(graph.starts)) < graph.ends
    return joined(graph.size, order[graph.lines], graph.lengths[once], graph.coordinates[np.argsort(order)])


def _one(name: str, told: Mapping[str, Any]) -> Graph:
    rows = {each.name for each in generators()[name] if each.kind is each.VAR_POSITIONAL}  # `*sizes`: told as a list
    try:
        row = [part for each in rows for part in told[each]]
        made = getattr(nx, name)(*row, **{each: told[each] for each in told.keys() - rows})
    except Exception as error:  # noqa: BLE001  a generator may raise anything about its parameters
        raise MapError(f"{name}: {type(error).__name__}: {shown(str(error), 200)}") from None
    if not isinstance(made, nx.Graph) or made.is_directed():
        raise MapError(f"{name}: got a {type(made).__name__}; expected a graph whose edges lead both ways")
    try:
        return converted(made).graph
    except Mistake as error:
        raise MapError(error.within(name)) from None
