"""Settings of value iteration networks: plan on what is seen and act on Q at the agent's cell (Tamar et al. 2016).

With `stitched: true` it plans on the map known so far (Khan et al. 2018, appendix B.1).
"""

from typing import Annotated, ClassVar

from pydantic import Field

from fogbench.learned.encoding.grid_sizes import CHANNELS
from fogbench.learned.grid_policy import GridPolicy
from fogbench.learned.shapes import Shapes, parts
from fogbench.learned.showing import Showing
from fogbench.learned.value_iteration.sizes import ACTIONS
from fogbench.learned.value_iteration.sizes import shapes as planner_shapes
from fogbench.worlds.settings import Probability


class Planning(Showing):
    """A policy with a VI module."""

    iterations: Annotated[int, Field(ge=1, le=1000)] = 16
    """K of the VI module."""
    discount: Probability | None = None
    """None leaves the value's kernels free, as in the paper; a number makes each a distribution times it."""


class Reacting(Planning):
    """A VI module, and nothing else; a subclass says what it sees and does."""

    made_of: ClassVar[str] = "fogbench.learned.networks.vin:VinNetwork"

    def shapes(self) -> Shapes:
        """Those of a VI module, and of a linear map of Q at one cell."""
        return parts(planner=planner_shapes(CHANNELS), output={"weight": (self.output_count, ACTIONS)})


class Vin(GridPolicy, Reacting):
    """VIN: value iteration on what the sensor shows, or on the stitched map, and nothing else."""
