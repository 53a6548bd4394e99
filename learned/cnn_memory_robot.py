"""Settings of CNN + Memory on robots (Khan et al. 2018, table 4)."""

from fogbench.learned.cnn_memory import Convolving
from fogbench.learned.robot_policy import RobotPolicy


class CnnMemoryRobot(RobotPolicy, Convolving):
    """CNN + Memory on robots: four convolutions on what the lidar shows ahead, then a memory."""
