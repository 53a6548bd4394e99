"""What networks see of graphs, by hand."""

import re
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from fogbench.learned.encoding.explored import ExploredEncoding
from fogbench.learned.encoding.graph import GraphEncoding
from fogbench.learned.macn_explored import MacnExplored
from fogbench.learned.macn_graph import MacnGraph
from fogbench.worlds.graph.conditions import GraphConditions
from fogbench.worlds.graph.graph import joined
from fogbench.worlds.graph.world import GraphWorld
from fogbench.worlds.mistake import Mistake

SQUARE: Any = MacnGraph(checkpoint="none", nodes=4)

PATH = [[0, 1], [1, 2], [2, 3]]


def world(coordinates: Any = None, lengths: Any = None) -> GraphWorld:
    """A path of four nodes, from the second to the last."""
    graph = joined(4, np.array(PATH, np.int32), lengths, coordinates)
    made = GraphConditions.model_validate({"budget": {"steps": 9}}).world(graph, 1, 3)
    assert made is not None
    return made


def walk(world: GraphWorld, viewpoint: Any, *nodes: int) -> None:
    """Look, and go to some nodes, with a look at each."""
    state, luck = world.reset(), np.random.default_rng(0)
    viewpoint.see(world.sense(state, luck))
    for node in nodes:
        state = world.step(state, viewpoint.act(node), luck).state
        viewpoint.see(world.sense(state, luck))


def test_a_row_becomes_a_square() -> None:
    """The neighbours, the goal and the node, each in two rows of two; the memory is told the same numbers."""
    encoding = GraphEncoding(SQUARE)
    viewpoint = encoding.start(world().task)
    walk(world(), viewpoint, 3)  # no neighbour
    inputs = encoding.encode([viewpoint])
    assert inputs.image.tolist() == [[[[1, 0], [1, 0]], [[0, 0], [0, 1]], [[0, 1], [0, 0]]]]
    assert inputs.cells.tolist() == [1]
    assert [part.tolist() for part in inputs.beside] == [[[1, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0]], [[1]]]
    assert encoding.open(inputs).tolist() == [[True, False, True, False]]
    assert encoding.outputs == ("node 0", "node 1", "node 2", "node 3")
    assert viewpoint.bytes == 0


def test_only_the_explored_graph_is_seen() -> None:
    """After a step from node 1 to node 2: four nodes and three edges are known, of which two nodes are to explore."""
    encoding = ExploredEncoding(MacnExplored(checkpoint="none", most=6))
    viewpoint = encoding.start(world().task)
    walk(world(), viewpoint, 2)
    inputs = encoding.encode([viewpoint])
    ln2, ln3 = np.log(2), np.log(3)
    assert inputs.nodes.tolist() == [0, 4]
    assert inputs.links.tolist() == [0, 6]
    assert inputs.is_end.tolist() == [True, False, False, True]
    assert np.allclose(inputs.frontier, [[0, ln2, 0], [0, ln3, 0], [0, ln3, 0], [1, ln2, 0]])
    ways = dict(zip(inputs.neighbours.tolist(), inputs.traits.tolist(), strict=True))
    assert np.allclose(ways[1], [0, 1, 1, ln3])
    assert np.allclose(ways[3], [1, 0, 0, ln2])
    assert inputs.steps.tolist() == [1, 1]
    assert np.allclose(inputs.told, [[ln3, ln2, 1, 0]])
    assert encoding.open(inputs).tolist() == [[False, True, False, True, False, False]]
    assert viewpoint.bytes == viewpoint.known.bytes


def test_lengths_and_lines_are_in_mean_lengths() -> None:
    """Those of edges that are known: here 2 and 4 of 2, 4 and 6, so that numbers mean the same on any map."""
    places = np.array([[0.0, 0], [2, 0], [6, 0], [12, 0]])
    made, encoding = world(places, np.array([2.0, 4, 6])), ExploredEncoding(MacnExplored(checkpoint="none", most=4))
    viewpoint = encoding.start(made.task)
    walk(made, viewpoint)
    inputs = encoding.encode([viewpoint])
    assert sorted(inputs.steps.tolist()) == pytest.approx([2 / 3, 4 / 3])
    assert np.allclose(inputs.frontier[:, 2], np.exp(-np.array([12, 10, 6, 0]) / 3 / 4))


def test_a_network_of_another_size_is_refused() -> None:
    """In a line, whoever meets it."""
    with pytest.raises(Mistake) as error:
        GraphEncoding(MacnGraph(checkpoint="none", nodes=9)).start(world().task)
    assert str(error.value) == "got a graph of 4 nodes; expected 9, the size"
    with pytest.raises(Mistake) as error:
        ExploredEncoding(MacnExplored(checkpoint="none", most=3)).start(world().task)
    assert str(error.value) == "got a graph of 4 nodes; expected at most 3 (set by `most`)"
    with pytest.raises(ValidationError, match=re.escape("a network for graphs of 5 nodes (this one is for 4)")):
        MacnGraph.model_validate({"checkpoint": "none", "nodes": 4}, context={"extent": (5,)})


def test_nodes_are_a_square_number() -> None:
    """The row of any other has no square."""
    with pytest.raises(ValidationError, match="a square number, such as 16: the row of a node is reshaped"):
        MacnGraph(checkpoint="none", nodes=15)
