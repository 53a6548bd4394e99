"""Where a robot takes itself to be: it adds up what its wheels tell it, with errors that stay."""

from math import hypot

import numpy as np

from fogbench.worlds.robot.driving import Pose, carried, wrapped


def odometry(drift: float, before: Pose, told: Pose, pose: Pose, rng: np.random.Generator) -> Pose:
    """What a robot is told after a decision; three numbers are drawn if there is any drift.

    Args:
        drift: standard deviation of the error, in m per m, rad per m and rad per rad.
        before: where it was.
        told: where it was told that it was.
        pose: where it is.
        rng: of the episode.
    """
    if not drift:
        return pose
    far, aside, turned = (drift * rng.standard_normal(3)).tolist()
    x, y, heading = carried(pose, before, told)
    driven, turn = hypot(pose[0] - before[0], pose[1] - before[1]), wrapped(pose[2] - before[2])
    wrong = aside * driven + turned * turn
    return told[0] + (1 + far) * (x - told[0]), told[1] + (1 + far) * (y - told[1]), wrapped(heading + wrong)
