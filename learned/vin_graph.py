"""Settings of VIN on graphs (Khan et al. 2018, table 3)."""

from fogbench.learned.graph_policy import GraphPolicy
from fogbench.learned.vin import Reacting


class VinGraph(GraphPolicy, Reacting):
    """VIN on graphs: value iteration on the row of a node, reshaped into a square, and nothing else."""
