"""Where the nodes of a graph are drawn: the same place at every step of an episode."""

from functools import lru_cache
from typing import Any

import numpy as np

from fogbench.worlds.graph.graph import Graph
from fogbench.worlds.types import Array

LARGEST = 2000
"""Nodes that a drawing pushes apart; more lie where the first two eigenvectors of the graph have them."""


@lru_cache(maxsize=4)
def drawn_at(graph: Graph) -> tuple[Array, tuple[float, float]]:
    """Rows and columns [N, 2] of all nodes, by their coordinates or else by a drawing, and how high and wide it is."""
    points = graph.coordinates * (1, -1) if graph.coordinates.size else _drawing(graph)  # y points up, rows go down
    side = 2 * float(np.sqrt(graph.size)) + 4
    spread = np.ptp(points, 0)
    scale = (side - 3) / max(float(spread.max()), 1e-12)
    at = (points - points.min(0))[:, ::-1] * scale + 1
    rows, columns = spread[::-1] * scale + 3
    return at, (max(float(rows), 3.0), max(float(columns), 3.0))


def _drawing(graph: Graph) -> Array:
    import networkx as nx  # noqa: PLC0415  only a picture needs it

    drawn: Any = nx.Graph()
    drawn.add_nodes_from(range(graph.size))
    drawn.add_edges_from(graph.lines.tolist())
    place = nx.spectral_layout if graph.size > LARGEST else lambda of: nx.spring_layout(of, seed=0)
    found: Array = np.array([at for _, at in sorted(place(drawn).items())])
    return found
