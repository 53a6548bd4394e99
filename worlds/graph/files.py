"""Files of graphs, read by networkx, and city maps; whatever is wrong with one is told in a line."""

import io
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import networkx as nx
import numpy as np

from fogbench.worlds.files import Loaded
from fogbench.worlds.graph.graph import Graph
from fogbench.worlds.graph.networks import converted, parts
from fogbench.worlds.graph.streets import streets
from fogbench.worlds.maps.files.octile import read_map
from fogbench.worlds.mistake import Mistake, counted, shown
from fogbench.worlds.types import MapError


def graphml(file: Loaded) -> Any:
    """A graph of networkx.

    Raises:
        Exception: whatever networkx says of a broken one.
    """
    return nx.read_graphml(io.BytesIO(file.contents))


def edge_list(file: Loaded) -> Any:
    """A graph of networkx: on each line two nodes, and behind them nothing, a dictionary, or the edge's weight.

    Raises:
        Exception: whatever networkx says of another line.
    """
    lines = (line.partition(b"#")[0].split() for line in file.contents.splitlines())
    first = next(filter(None, lines), [])
    weighted = len(first) == 3 and not first[2].startswith(b"{")
    reader: Any = nx.read_weighted_edgelist if weighted else nx.read_edgelist
    return reader(io.BytesIO(file.contents))


def city(file: Loaded) -> Any:
    """The graph of networkx of a city map's streets.

    Raises:
        MapError: the map is broken.
        Mistake: it has none.
    """
    return streets(read_map(file.path, file.contents))


READERS: Mapping[str, Callable[[Loaded], Any]] = {".graphml": graphml, ".edgelist": edge_list, ".map": city}
"""Of the files that end so."""


class Read(NamedTuple):
    """A graph of a file."""

    graph: Graph
    numbers: Mapping[str, int]
    """Of the nodes, by their names in the file."""
    notes: list[str]
    """What of the file does not count."""


def read_graph(file: Loaded, both_ways: bool) -> Read:
    """The graph of a file.

    Raises:
        MapError: it is broken, directed, or in parts; one line.
    """
    try:
        source = READERS[file.path.suffix](file)
        refuse_directed(source, both_ways)
        graph, names = converted(source)
    except MapError:
        raise
    except Mistake as error:
        raise MapError(f"{file.path}: {error}") from None
    except Exception as error:  # noqa: BLE001  whatever a broken file does to its reader
        raise MapError(f"{file.path}: {type(error).__name__}: {shown(str(error), 200)}") from None
    refuse_parts(file, graph, names)
    return Read(graph, {str(name): k for k, name in enumerate(names)}, notes(source, graph))


def refuse_directed(source: Any, both_ways: bool) -> None:
    """Go on with a graph of networkx whose edges lead both ways, or are read so.

    Raises:
        Mistake: they lead one way.
    """
    if source.is_directed() and not both_ways:
        raise Mistake("got a directed graph; expected edges that lead both ways, or `both_ways: true` to read them so")


def refuse_parts(file: Loaded, graph: Graph, names: list[Any]) -> None:
    """Go on with a connected graph.

    Raises:
        MapError: it has no two nodes, a node without an edge, or more than one part.
    """
    if graph.size < 2:
        raise MapError(f"{file.path}: got {counted(graph.size, 'node')}; expected at least 2")
    alone = np.flatnonzero(np.diff(graph.starts) == 0)
    if len(alone):
        first = shown(str(names[alone[0]]))
        raise MapError(f"{file.path}: node {first}: got no edge; expected a path from each node to each other")
    if (count := parts(graph)) > 1:
        raise MapError(f"{file.path}: got {count} parts that no edge joins; expected one")


def notes(source: Any, graph: Graph) -> list[str]:
    """What of a graph of networkx does not count in ours."""
    loops, edges = nx.number_of_selfloops(source), source.number_of_edges()
    more = edges - loops - len(graph.lines)
    told = [f"{counted(loops, 'edge')} from a node to itself {'is' if loops == 1 else 'are'} left out"] if loops else []
    return [*told, *([f"of edges between the same nodes the shortest counts, {more} are left out"] if more else [])]
