"""The view in three dimensions: an image, or one line that says that this machine cannot render."""

import os
import subprocess
import sys
from pathlib import Path

import fogbench

CODE = """
import sys
sys.path[:0] = sys.argv[1:]
import numpy as np
from conftest import conditions_of, strewn
from fogbench.worlds.maps.layout import Layout, fit
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.robot.rendering import rendered
rng = np.random.default_rng(1)
world = fit(Layout(strewn(rng)), conditions_of(), rng)
try:
    image = rendered(world, world.reset(), 120, 160)
    print("image", image.shape, image.dtype, len(np.unique(image.reshape(-1, 3), axis=0)) > 50)
except Mistake as mistake:
    print(mistake)
"""


def test_a_view_or_a_line() -> None:
    """Of a size that is asked for, with the colours of a scene."""
    places = [str(Path(__file__).parent), str(Path(fogbench.__file__).parents[1])]
    environment = {**os.environ, "MUJOCO_GL": "egl"}
    command = [sys.executable, "-c", CODE, *places]
    told = subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout.strip()
    assert told == "image (120, 160, 3) uint8 True" or told.endswith("(egl, osmesa or glfw).")
