"""What knows which actions are right, by what an agent itself has seen. Each kind of world may name its own.

A class that `fogbench.planners.JUDGES` names is started with the task of an episode. It follows the agent's own known
map, and teaches: imitation learns its targets. If it also judges, decisions are counted as right or wrong. It may have
a classmethod `hindsight(world)`, which starts one that also knows the world, for training alone; and one,
`side_by_side(slots, hindsight=)`, which makes teachers of many episodes that are faster together (see `teachers`).
"""

from typing import Any, NamedTuple, Protocol, runtime_checkable

from fogbench.worlds.types import Observation


class Verdict(NamedTuple):
    """What is said of one decision."""

    judged: bool
    """Whether any action was right: without a way to the goal on the known map none is right or wrong."""
    wrong: bool
    """Whether no optimal plan on the known map begins with it."""
    strictly_wrong: bool
    """Whether the reference of the kind would decide otherwise on the same known map."""


NOT_JUDGED = Verdict(judged=False, wrong=False, strictly_wrong=False)


class Teacher(Protocol):
    """**Protocol:** follows one agent's known map and says what is right there."""

    def see(self, observation: Observation) -> None:
        """Take in what the agent is told; once for every observation, in order."""

    def targets(self) -> Any:
        """What imitation learns at the last observation.

        Where actions are few, [A] bool: which are right, in the order of the encoding's outputs; none where that is
        undefined.
        """


@runtime_checkable
class Judge(Teacher, Protocol):
    """**Protocol:** a teacher that also judges."""

    def judge(self, action: Any) -> Verdict:
        """The verdict on an action that was taken on the last observation."""
