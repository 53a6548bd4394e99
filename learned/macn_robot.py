"""Settings of MACN on robots (Khan et al. 2018, section 4 and table 4)."""

from typing import ClassVar

from fogbench.learned.macn import PlanningAndRemembering
from fogbench.learned.robot_policy import RobotPolicy


class MacnRobot(RobotPolicy, PlanningAndRemembering):
    """MACN on robots: value iteration on what the lidar shows ahead, then a DNC, an LSTM, a GRU or no memory."""

    made_of: ClassVar[str] = "fogbench.learned.networks.macn:PlanningNetwork"
