"""A robot world in three dimensions, where MuJoCo can render: without a screen by `MUJOCO_GL=egl` around it."""

from math import degrees

import mujoco

from fogbench.worlds.mistake import Mistake
from fogbench.worlds.robot.rules import Outfit
from fogbench.worlds.robot.simulation import Simulation
from fogbench.worlds.robot.world import RobotState, RobotWorld
from fogbench.worlds.types import Array

FAR, TILT = 5.0, -40.0
"""Metres from the camera to the robot, and how far it looks down [degrees]."""


def rendered(world: RobotWorld, state: RobotState, height: int = 480, width: int = 640) -> Array:
    """What a camera behind the robot shows: [height, width, 3] uint8.

    Raises:
        Mistake: this machine cannot render.
    """
    outfit: Outfit = world.task.sensor
    sim = Simulation(world.cells, outfit.cell, outfit.body)
    sim.start(state.place)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = *state.place[:2], outfit.body.radius
    camera.distance, camera.elevation, camera.azimuth = FAR, TILT, degrees(state.place[2])
    try:
        with mujoco.Renderer(sim.model, height, width) as renderer:
            renderer.update_scene(sim.data, camera)
            picture: Array = renderer.render()
    except Exception as error:
        told = f"got {type(error).__name__}: {error}"
        raise Mistake(f"MUJOCO_GL: {told}; expected a machine that can render (egl, osmesa or glfw).") from error
    return picture
