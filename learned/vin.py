"""Settings of value iteration networks: plan on what is seen and act on Q at the agent's cell (Tamar et al. 2016).

With `stitched: true` it plans on the map known so far (Khan et al. 2018, appendix B.1).
"""

from typing import Annotated, ClassVar

from pydantic import Field

from fogbench.learned.encoding.grid_sizes import CHANNELS, OUTPUTS
from fogbench.learned.grid_policy import GridPolicy
from fogbench.learned.shapes import Shapes, parts
from fogbench.learned.value_iteration.sizes import ACTIONS
from fogbench.learned.value_iteration.sizes import shapes as planner_shapes
from fogbench.worlds.settings import Probability


class Planning(GridPolicy):
    """A policy with a VI module."""

    iterations: Annotated[int, Field(ge=1, le=1000)] = 16
    """K of the VI module."""
    discount: Probability | None = None
    """None leaves the value's kernels free, as in the paper; a number makes each a distribution times it."""


class Vin(Planning):
    """VIN: value iteration on what the sensor shows, or on the stitched map, and nothing else."""

    made_of: ClassVar[str] = "fogbench.learned.networks.vin:VinNetwork"

    def shapes(self) -> Shapes:
        """Those of a VI module, and of a linear map of Q at one cell."""
        return parts(planner=planner_shapes(CHANNELS), output={"weight": (len(OUTPUTS), ACTIONS)})
