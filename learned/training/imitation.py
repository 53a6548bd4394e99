"""How a network learns by imitation, as it stands in a recipe. Importing this imports no torch."""

from pkgutil import resolve_name
from typing import Annotated, Any, Literal

from pydantic import Field

from fogbench.learned.training.recipe import Recipe, Student
from fogbench.worlds.settings import Positive, PositiveRange, Probability, Settings

Rate = Annotated[float, Field(gt=0, le=1000)]
"""A number above 0."""

Weight = Annotated[float, Field(ge=0, le=1000)]
"""A number from 0."""


class Teacher(Settings):
    """Who decides while training: the teacher, or the network as it is (Ross, Gordon & Bagnell 2011, "DAgger").

    The teacher takes an optimal move on the map that the agent has seen. Whoever decides, the network is taught which
    moves are optimal there.
    """

    share: tuple[Probability, Probability] = (1.0, 0.1)
    """Share of the episodes in which the teacher decides: at first, and from `until` on; `[1, 1]` is cloning."""
    until: Probability = 0.25
    """Part of the batches over which the share changes."""
    hindsight: bool = False
    """Whether, of the moves that are optimal on that map, only those count that are on the full map too, if any is."""


class Curriculum(Settings):
    """Tasks that grow harder over the first batches."""

    easy: dict[str, Any] = Field(default_factory=dict)
    """Settings of the maps of every lesson at first: numbers grow to the lesson's own, the rest changes at the end."""
    distance: PositiveRange | None = None
    """Bounds of the optimum at first; they grow to the `tasks.distance` of each lesson."""
    until: Probability = 0.3
    """Part of the batches over which they grow."""


class Imitation(Settings):
    """Imitation of the planner that has seen the same, where the network's own decisions lead it."""

    batches: Positive
    """How many, each of fresh maps."""
    batch: Annotated[int, Field(ge=1, le=10_000)] = 128
    """Episodes of a batch."""
    teacher: Teacher = Teacher()
    curriculum: Curriculum | None = None
    optimiser: Literal["adam", "rmsprop"] = "adam"
    """Adam or RMSProp, as PyTorch has them."""
    rate: tuple[Rate, Rate] = (1e-3, 1e-4)
    """Learning rate over the first half of the batches, and at the end of the second, over which it falls."""
    clip: Rate = 5.0
    """The gradient's norm at most."""
    average: Annotated[int, Field(ge=1, le=10_000)] = 1
    """Batches over which weights are averaged, those of longer ago counting less; the mean is what is tried and kept
    (Polyak & Juditsky 1992). 1: the weights as they are."""
    access_decay: Weight = 0.0
    """Squared weights of a DNC's interface to its memory count as much in the loss (Khan et al. 2018, section 4.2)."""
    noise: Weight = 0.0
    """Standard deviation of the noise on the controller's output that it remembers."""

    def student(self, recipe: Recipe) -> Student:
        """A network before its first batch."""
        student: Student = resolve_name("fogbench.learned.training.student:Imitator")(recipe, self)
        return student
