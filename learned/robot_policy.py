"""What the settings of policies on robots share: what they see, what they choose among, and a mask."""

from pkgutil import resolve_name
from typing import ClassVar

import numpy as np

from fogbench.learned.encoding.robot_sizes import CHOICES, SEEN, WINDOW
from fogbench.learned.policy import AGENT
from fogbench.learned.showing import Showing
from fogbench.worlds.types import Agent, Task


class RobotPolicy(Showing):
    """A network as an agent in robot worlds: it sees the current scan alone (Khan et al. 2018, section 4)."""

    kinds: ClassVar[frozenset[str]] = frozenset({"robot"})

    masked: bool = False
    """Whether it takes no waypoint that its scan shows to be blocked; any weights can be played so."""

    @property
    def plane(self) -> tuple[int, int]:
        """The paper's 10x10."""
        return WINDOW, WINDOW

    @property
    def seen_count(self) -> int:
        """Numbers of the image, the beams and the compass."""
        return SEEN

    @property
    def output_count(self) -> int:
        """Places around the robot, and turns on the spot."""
        return CHOICES

    def start(self, task: Task, rng: np.random.Generator) -> Agent:
        """A fresh agent; it needs no luck."""
        del rng
        kind = "MaskedAgent" if self.masked else "PolicyAgent"
        agent: Agent = resolve_name(f"{AGENT}:{kind}")(self, task)
        return agent
