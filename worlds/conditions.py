"""Conditions that kinds of world share: which tasks are drawn, and what an episode may use up."""

from typing import Annotated, Any, ClassVar

from pydantic import Discriminator, Field, Tag

from fogbench.worlds.settings import Count, Positive, PositiveRange, Settings
from fogbench.worlds.types import Budget

LONGEST = 1_000_000
"""Seconds that an episode can be given, 11 days; the clocks of an operating system count milliseconds in 32 bits."""


class Conditions(Settings):
    """The conditions of a kind of world: a subclass adds its blocks, among them `budget: BudgetSettings`."""

    covariates: ClassVar[tuple[str, ...]] = ()
    """What `World.covariates` tells of such worlds."""


class PerDistance(Settings):
    """A step budget that grows with the straight distance: `per_distance * distance + plus` steps, rounded down.

    The straight distance is what every agent can compute from its task: the length of the optimal path if nothing were
    in the way. The true optimum would tell the agent about the map.
    """

    per_distance: Annotated[float, Field(gt=0, le=1000)]
    """Steps for each unit of the straight distance."""
    plus: Count = 0
    """Steps added to that."""


def _form(steps: Any) -> str:
    return "mapping" if isinstance(steps, dict | PerDistance) else "number"


StepBudget = Annotated[
    Annotated[Positive, Tag("number")] | Annotated[PerDistance, Tag("mapping")],
    Discriminator(_form),
]


class BudgetSettings(Settings):
    """The `budget` block: decisions, the hard limit against hangs [s], and bytes carried between decisions."""

    steps: StepBudget
    """Decisions of an episode, as a number or by the straight distance."""
    hard_seconds: Annotated[float, Field(gt=0, le=LONGEST)] = 300.0
    """Seconds after which an episode, the start of its agent included, is ended from outside and counts as HUNG."""
    memory_bytes: Annotated[int, Field(ge=1, le=10**15)] | None = None
    """Bytes that an agent may carry from one decision to the next; by default any number."""

    def over(self, straight: float) -> Budget:
        """The budget of a task whose goal is `straight` away, in the length unit of its kind."""
        steps = self.steps
        if isinstance(steps, PerDistance):
            steps = max(1, int(steps.per_distance * straight + steps.plus))
        return Budget(steps, self.hard_seconds, self.memory_bytes)


class Tasks(Settings):
    """The `tasks` block of kinds where a step is one unit of length: which tasks are drawn."""

    distance: PositiveRange | None = None
    """Bounds of the full-map optimum, both included; by default 1 and the task's step budget."""

    def bounds(self, budget: Budget) -> tuple[int, int]:
        """The least and the largest optimum of a task with this budget."""
        return self.distance or (1, budget.steps)

    def wanted(self, unit: str) -> str:
        """The bounds, in words for an error."""
        if self.distance is None:
            return "an optimum inside the step budget (set by `budget: {steps: ...}`)"
        return f"an optimum of {self.distance[0]} to {self.distance[1]} {unit} (set by `tasks: {{distance: ...}}`)"
