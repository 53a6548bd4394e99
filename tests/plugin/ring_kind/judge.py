"""Right and wrong on a ring."""

import numpy as np

from fogbench import NOT_JUDGED, Array, Observation, Task, Verdict
from ring_kind.world import KnownRing, Way, ahead


class RingJudge:
    """Follows one agent's known ring; every shortest way there is right."""

    def __init__(self, task: Task) -> None:
        """Nothing is known yet."""
        self.goal: int = task.goal
        self.known = KnownRing(int(task.extent[0]))
        self.place = -1

    def see(self, observation: Observation) -> None:
        """Take in what the agent sees."""
        self.known.update(observation)
        self.place = observation.place

    def targets(self) -> Array:
        """Which ways are right: [2] bool."""
        ways = np.array(ahead(self.known.links, self.place, self.goal))
        right: Array = np.isfinite(ways) & (ways == ways.min())
        return right

    def judge(self, action: Way) -> Verdict:
        """The verdict on a way; the reference takes the first that is right."""
        right = self.targets()
        if not right.any():
            return NOT_JUDGED
        return Verdict(judged=True, wrong=not right[action], strictly_wrong=action != right.argmax())
