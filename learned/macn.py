"""Settings of memory augmented control networks: plan on what is seen, remember, decide (Khan et al. 2018)."""

from math import prod
from typing import ClassVar

from fogbench.learned.cnn_memory import LAST
from fogbench.learned.convolution.sizes import shapes as convolutional_shapes
from fogbench.learned.encoding.grid_sizes import CHANNELS, SIGHT
from fogbench.learned.grid_policy import GridPolicy
from fogbench.learned.memory import Remembering
from fogbench.learned.policy import Size
from fogbench.learned.shapes import Shapes, parts
from fogbench.learned.value_iteration.sizes import ACTIONS
from fogbench.learned.value_iteration.sizes import shapes as planner_shapes
from fogbench.learned.vin import Planning


class PlanningAndRemembering(Planning, Remembering):
    """A VI module before a memory; a subclass says what it sees and does."""

    @property
    def planned(self) -> int:
        """Numbers from the VI module: the values of all cells, and Q at the agent's."""
        return prod(self.plane) + ACTIONS

    def shapes(self) -> Shapes:
        """Those of a VI module before a memory."""
        return self.remembering_shapes(self.planned) | parts(planner=planner_shapes(CHANNELS))


class Macn(GridPolicy, PlanningAndRemembering):
    """MACN: value iteration and four convolutions on what the sensor shows, then a DNC, an LSTM, a GRU or no memory."""

    made_of: ClassVar[str] = "fogbench.learned.networks.macn:MacnNetwork"

    channels: Size | None = 16
    """Of the first three of four convolutions on the cells around the agent; null: it is told the cells alone."""

    @property
    def convolved(self) -> int:
        """Numbers from the last convolution."""
        return LAST * (2 * SIGHT + 1) ** 2 if self.channels else 0

    def shapes(self) -> Shapes:
        """Those of a VI module, and of convolutions beside it, before a memory."""
        beside = parts(convolutions=convolutional_shapes(CHANNELS, self.channels, LAST)) if self.channels else {}
        planner = parts(planner=planner_shapes(CHANNELS))
        return self.remembering_shapes(self.planned + self.convolved) | planner | beside
