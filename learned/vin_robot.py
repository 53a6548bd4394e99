"""Settings of VIN on robots (Khan et al. 2018, table 4)."""

from fogbench.learned.robot_policy import RobotPolicy
from fogbench.learned.vin import Reacting


class VinRobot(RobotPolicy, Reacting):
    """VIN on robots: value iteration on what the lidar shows ahead, and nothing else."""
