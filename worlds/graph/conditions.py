"""Everything in a scenario that is neither graphs nor agents, for worlds of kind `graph`."""

from typing import ClassVar

from fogbench.worlds.conditions import BudgetSettings, Conditions
from fogbench.worlds.graph.distances import FAR, distances, hops
from fogbench.worlds.graph.graph import Graph
from fogbench.worlds.graph.rules import GraphRules, GraphTasks
from fogbench.worlds.graph.world import COVARIATES, GraphWorld
from fogbench.worlds.types import Task


class GraphConditions(Conditions):
    """The conditions of a graph: whether steps fail, which tasks are drawn, what they may use up."""

    covariates: ClassVar[tuple[str, ...]] = COVARIATES

    rules: GraphRules = GraphRules()
    tasks: GraphTasks = GraphTasks()
    budget: BudgetSettings

    def world(self, graph: Graph, start: int, goal: int) -> GraphWorld | None:
        """The world of one task on a graph, or None where no path leads to the goal or it is out of bounds."""
        if start == goal:
            return None
        edges = int(hops(graph.starts, graph.ends, goal)[start])
        budget = self.budget.over(graph.straight(start, goal))
        if edges == FAR or (self.tasks.distance is None and edges > budget.steps):
            return None
        optimum = float(edges) if graph.unit else float(distances(graph, goal)[start])
        least, most = self.tasks.distance or (0.0, optimum)
        if not least <= optimum <= most:
            return None
        task = Task("graph", goal, None, budget, (graph.size,))
        return GraphWorld(graph, start, task, self.rules.slip, optimum, edges)
