"""Settings of CNN + Memory on graphs (Khan et al. 2018, table 3)."""

from fogbench.learned.cnn_memory import Convolving
from fogbench.learned.graph_policy import GraphPolicy


class CnnMemoryGraph(GraphPolicy, Convolving):
    """CNN + Memory on graphs: four convolutions on the row of a node, reshaped into a square, then a memory."""
