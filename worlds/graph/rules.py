"""What happens when a step on a graph fails, and which tasks are drawn there."""

from fogbench.worlds.settings import PositiveRange, Probability, Settings


class GraphRules(Settings):
    """What happens when a step fails; an action that is no neighbour always costs a step and leads nowhere."""

    slip: Probability = 0.0
    """Probability that the agent stays where it is."""


class GraphTasks(Settings):
    """Which tasks are drawn."""

    distance: PositiveRange | None = None
    """Bounds of the optimum on the full graph, both included; by default any whose path of the fewest edges has no more
    of them than the step budget."""

    def wanted(self) -> str:
        """The bounds, in words for an error."""
        if self.distance is None:
            return "a path inside the step budget (set by `budget: {steps: ...}`)"
        return f"an optimum of {self.distance[0]} to {self.distance[1]} (set by `tasks: {{distance: ...}}`)"
