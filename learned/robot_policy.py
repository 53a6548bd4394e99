"""What the settings of policies on robots share: what they see, what they choose among, and a mask."""

from pkgutil import resolve_name
from typing import ClassVar

import numpy as np

from fogbench.learned.encoding.robot_sizes import CHOICES, seen_count
from fogbench.learned.policy import AGENT, Size
from fogbench.learned.showing import Showing
from fogbench.worlds.robot.rules import Metres
from fogbench.worlds.types import Agent, Task


class RobotPolicy(Showing):
    """A network as an agent in robot worlds: it sees the current scan, not the map (Khan et al. 2018, section 4)."""

    kinds: ClassVar[frozenset[str]] = frozenset({"robot"})

    window: Size = 10
    """Rows and columns of the image that it plans on; the robot stands at the middle of its lower edge and looks up."""
    cell: Metres = 0.5
    """Side of the image's cells [m]."""
    masked: bool = False
    """Whether it takes no waypoint that its scan shows to be blocked; any weights can be played so."""

    @property
    def plane(self) -> tuple[int, int]:
        """The paper's 10x10."""
        return self.window, self.window

    @property
    def seen_count(self) -> int:
        """Numbers of the image, the beams and the compass."""
        return seen_count(self.window)

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
