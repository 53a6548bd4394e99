"""Settings of memory augmented control networks: plan on what is seen, remember, decide (Khan et al. 2018)."""

from math import prod
from typing import ClassVar

from fogbench.learned.encoding.grid_sizes import CHANNELS
from fogbench.learned.memory import Remembering
from fogbench.learned.shapes import Shapes, parts
from fogbench.learned.value_iteration.sizes import ACTIONS
from fogbench.learned.value_iteration.sizes import shapes as planner_shapes
from fogbench.learned.vin import Planning


class Macn(Planning, Remembering):
    """MACN: value iteration on what the sensor shows, then a DNC, an LSTM or no memory."""

    made_of: ClassVar[str] = "fogbench.learned.networks.macn:MacnNetwork"

    @property
    def planned(self) -> int:
        """Numbers from the VI module: the values of all cells, and Q at the agent's."""
        return prod(self.size) + ACTIONS

    def shapes(self) -> Shapes:
        """Those of a VI module before a memory."""
        return self.remembering_shapes(self.planned) | parts(planner=planner_shapes(CHANNELS))
