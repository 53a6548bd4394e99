"""Settings of MACN on graphs, as the paper has it: value iteration on the row of a node, reshaped into a square."""

from typing import ClassVar

from fogbench.learned.graph_policy import GraphPolicy
from fogbench.learned.macn import PlanningAndRemembering


class MacnGraph(GraphPolicy, PlanningAndRemembering):
    """MACN on graphs: value iteration on a reshaped row, then a DNC, an LSTM, a GRU or no memory."""

    made_of: ClassVar[str] = "fogbench.learned.networks.macn:PlanningNetwork"
