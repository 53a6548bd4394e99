"""The streets of a city map as a graph: crossings and dead ends are its nodes, pieces of street between them its edges.

    python -m fogbench.worlds.graph.streets MAP OUT.graphml

MAP is a `.map` file of the Moving AI Lab. Its free space is thinned to lines of one cell. Where lines meet or end,
there is a node, with `x` and `y` in cells, `y` upwards; an edge has the `length` of its line. Nodes that are closer
than the street between them is wide are one, for a wide crossing leaves several, and corners leave short spurs. Of
several streets between the same nodes the shortest counts, and of several parts the largest.
"""

from argparse import ArgumentParser
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
from scipy.ndimage import distance_transform_edt

from fogbench.worlds.maps.files.octile import read_map
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array, Cell

AROUND = ((-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1))
"""Steps from a cell to the eight around it, clockwise from above."""


def main() -> None:
    """Read a map, write its graph, say how large that is."""
    parser = ArgumentParser(prog="python -m fogbench.worlds.graph.streets", description=__doc__.partition("\n")[0])
    parser.add_argument("map", type=Path, help="a .map file of the Moving AI Lab")
    parser.add_argument("out", type=Path, help="the GraphML file that is written")
    asked = parser.parse_args()
    try:
        graph = streets(read_map(asked.map, asked.map.read_bytes()))
        nx.write_graphml(graph, asked.out)
    except (Mistake, OSError) as error:
        parser.error(str(error))
    print(f"{asked.out}: {len(graph)} nodes, {graph.number_of_edges()} edges")  # noqa: T201  it is a script


def streets(blocked: Array) -> Any:
    """The graph of networkx of a map [H, W] bool; a node is called `column,row`.

    Raises:
        Mistake: the map has no street.
    """
    lines, widths = pieces(pixels(thinned(~blocked))), 2 * distance_transform_edt(np.pad(~blocked, 1))[1:-1, 1:-1]
    graph = crossings(merged(lines, widths))
    if not graph.number_of_edges():
        raise Mistake("got a map without a street; expected two crossings or dead ends at least")
    part = graph.subgraph(max(nx.connected_components(graph), key=len)).copy()
    for (row, column), place in part.nodes(data=True):
        place["x"], place["y"] = float(column), float(len(blocked) - 1 - row)
    return nx.relabel_nodes(part, {(row, column): f"{column},{row}" for row, column in part})


def thinned(free: Array) -> Array:
    """The middle lines of free space [H, W] bool, one cell wide (Zhang & Suen 1984)."""
    image, left = np.pad(free, 1), -1
    while image.sum() != left:
        left = image.sum()
        for first, second in (((0, 2, 4), (2, 4, 6)), ((0, 2, 6), (0, 4, 6))):
            around = np.stack([np.roll(image, (-down, -right), (0, 1)) for down, right in AROUND])  # [8, H + 2, W + 2]
            count, begins = around.sum(0), (~around & np.roll(around, -1, 0)).sum(0)
            kept = around[list(first)].all(0) | around[list(second)].all(0)
            image &= kept | (count < 2) | (count > 6) | (begins != 1)
    return image[1:-1, 1:-1]


def pixels(lines: Array) -> Any:
    """Cells of lines [H, W] bool, each joined to those around it; not across a corner where a third joins them."""
    cells = {*map(tuple, np.argwhere(lines).tolist())}
    graph: Any = nx.MultiGraph()
    graph.add_nodes_from(sorted(cells))
    for row, column in sorted(cells):
        for down, right in AROUND[2:6]:
            other, corners = (row + down, column + right), {(row + down, column), (row, column + right)}
            if other in cells and (not (down and right) or not corners & cells):
                graph.add_edge((row, column), other, length=float(np.hypot(down, right)))
    return graph


def pieces(graph: Any) -> Any:
    """The same graph without nodes that lie between two others: their edges become one."""
    graph = nx.MultiGraph(graph)
    for node in [*graph]:
        edges = [*graph.edges(node, data="length")]
        if graph.degree(node) == len(edges) == 2:  # a loop has two ends
            graph.remove_node(node)
            graph.add_edge(edges[0][1], edges[1][1], length=edges[0][2] + edges[1][2])
    return graph


def merged(graph: Any, widths: Array) -> Any:
    """The same graph with one node, the widest, in place of those closer than the street [H, W] between them is wide.

    That is as wide as at the narrower end; a dead end is held against the crossing that it leads to.
    """
    close: Any = nx.Graph()
    close.add_nodes_from(graph)
    for a, b, length in graph.edges(data="length"):
        width = (max if 1 in {graph.degree(a), graph.degree(b)} else min)(widths[a], widths[b])
        close.add_edges_from([(a, b)] if length < width else [])
    groups = [(max(sorted(group), key=widths.__getitem__), group) for group in nx.connected_components(close)]
    middle = {node: widest for widest, group in groups for node in group}
    joined: Any = nx.MultiGraph()
    joined.add_nodes_from(middle.values())
    for a, b, length in graph.edges(data="length"):
        joined.add_edge(middle[a], middle[b], length=length + apart(a, middle[a]) + apart(b, middle[b]))
    return joined


def apart(a: Cell, b: Cell) -> float:
    """The straight line between two cells."""
    return float(np.hypot(a[0] - b[0], a[1] - b[1]))


def crossings(graph: Any) -> Any:
    """The same graph without loops, longer streets between the same nodes, and nodes between two others."""
    plain: Any = nx.Graph()
    plain.add_nodes_from(graph)
    for length, a, b in sorted(((length, a, b) for a, b, length in graph.edges(data="length")), reverse=True):
        if a != b:
            plain.add_edge(a, b, length=length)
    return plain if all(count != 2 for _, count in plain.degree) else crossings(pieces(plain))


if __name__ == "__main__":
    main()
