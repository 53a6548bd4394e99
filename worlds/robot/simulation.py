"""The robot in MuJoCo: walls of boxes, a round body, two driven wheels, two casters, friction and contacts."""

import mujoco
import numpy as np

from fogbench.worlds.robot.driving import Pose, command
from fogbench.worlds.robot.rules import TICK, Body
from fogbench.worlds.robot.unicycle import Drive
from fogbench.worlds.robot.walls import rectangles
from fogbench.worlds.types import Array

SUBSTEPS = 4
"""Steps of the physics in a tick."""

WHOLE = mujoco.mjtState.mjSTATE_INTEGRATION
"""All that decides what comes next."""

HEIGHT, DEPTH = 0.4, 0.5
"""Of walls, and of those around the map [m]."""

WHEEL, TRACK, CASTER = 0.3, 1.5, 0.8
"""Radius of a wheel, the way between both, and from the middle to a caster, in radii of the body."""

HUNG = 0.002
"""Metres that casters hang above the floor: level with the wheels they would take their load."""

ROTOR, GAIN = 5.5, 1950.0
"""Inertia [kg m2] and torque for a difference in speed [N m s] of a motor, for a wheel of 1 m: so that the body follows
its commands within millimetres as it speeds up."""

# Ellipsoids, because cylinders scrub as they turn; an elliptic cone, because a pyramid climbs walls. Wheels and casters
# touch the floor alone, and the body walls alone, so that a touch of the body is one of a wall.
MODEL = """
<mujoco>
  <option timestep="{step}" integrator="implicitfast" cone="elliptic" impratio="10"/>
  <statistic extent="{extent}" center="{x} {y} 0"/>
  <visual><global offwidth="1280" offheight="960"/></visual>
  <default><geom solref="0.01 1"/></default>
  <worldbody>
    <light pos="{x} {y} {extent}" dir="0 0 -1" directional="true"/>
    <geom name="floor" type="plane" size="{extent} {extent} 1" pos="{x} {y} 0" rgba=".9 .9 .9 1"/>
    {walls}
    <body name="robot" pos="0 0 {wheel}">
      <freejoint/>
      <site name="skin" type="cylinder" size="{skin} {half}" pos="0 0 {middle}" rgba="0 0 0 0"/>
      <inertial pos="0 0 0" mass="6" diaginertia="{inertia} {inertia} {inertia}"/>
      <geom type="cylinder" size="{radius} {half}" pos="0 0 {middle}" contype="2" conaffinity="2" friction="0.1"
        rgba=".84 .37 0 1"/>
      <geom type="box" size="{nose} .01 .01" pos="{nose} 0 {roof}" contype="0" conaffinity="0"/>
      <geom type="sphere" size="{ball}" pos="{front} 0 {low}" condim="1" priority="1"/>
      <geom type="sphere" size="{ball}" pos="-{front} 0 {low}" condim="1" priority="1"/>
      <body pos="0 {out} 0"><joint name="left" {axle}/><geom {tyre}/></body>
      <body pos="0 -{out} 0"><joint name="right" {axle}/><geom {tyre}/></body>
    </body>
  </worldbody>
  <actuator><velocity joint="left" kv="{gain}"/><velocity joint="right" kv="{gain}"/></actuator>
  <sensor><touch site="skin"/></sensor>
</mujoco>
"""


class Simulation:
    """A model of one map, and one state of it."""

    def __init__(self, cells: Array, cell: float, body: Body) -> None:
        """Build the model.

        Args:
            cells: [H, W] uint8, the true map.
            cell: side of its cells [m].
            body: of the robot.
        """
        self.body = body
        self.model = mujoco.MjModel.from_xml_string(_xml(cells, cell, body))
        self.data = mujoco.MjData(self.model)

    def start(self, pose: Pose) -> Array:
        """The whole state of a robot that stands still at a pose, after it has settled on its wheels."""
        mujoco.mj_resetData(self.model, self.data)
        self._place(pose)
        mujoco.mj_step(self.model, self.data, nstep=round(0.5 / TICK) * SUBSTEPS)
        self._place(pose)
        self.data.qvel[:] = 0
        mujoco.mj_forward(self.model, self.data)
        return self.state()

    def state(self) -> Array:
        """[n] float64, all that decides what comes next; read-only."""
        state = np.empty(mujoco.mj_stateSize(self.model, WHOLE))
        mujoco.mj_getState(self.model, self.data, state, WHOLE)
        state.setflags(write=False)
        return state

    def drive(
        self, state: Array, v: float, w: float, waypoint: Pose, goal: tuple[float, float], near: float, *, on: bool
    ) -> Drive:
        """Drive towards a waypoint for one decision, or until the goal is `near` [m]; `on`: walls do not end it."""
        mujoco.mj_setState(self.model, self.data, state, WHOLE)
        limits, length, touched, reached = self.body.limits, 0.0, False, False
        pose = self.pose()
        for _ in range(self.body.ticks):
            v, w = command(pose, v, w, waypoint, limits)
            touched |= self._tick(v, w)
            before, pose = pose, self.pose()
            length += np.hypot(pose[0] - before[0], pose[1] - before[1])
            reached = (pose[0] - goal[0]) ** 2 + (pose[1] - goal[1]) ** 2 <= near * near
            if reached or (touched and not on):
                break
        return Drive(pose, v, w, float(length), touched, bool(reached))

    def pose(self) -> Pose:
        """Where the body is."""
        x, y, _, a, b, c, d = self.data.qpos[:7].tolist()
        return x, y, float(np.arctan2(2 * (a * d + b * c), 1 - 2 * (c * c + d * d)))

    def _tick(self, v: float, w: float) -> bool:
        """Tell the wheels how fast to turn, and whether a wall was touched."""
        model, data, touched = self.model, self.data, False
        wheel, out = WHEEL * self.body.radius, TRACK * self.body.radius / 2
        data.ctrl[:] = (v - w * out) / wheel, (v + w * out) / wheel
        for _ in range(SUBSTEPS):
            mujoco.mj_step(model, data)
            touched |= data.sensordata[0] > 0
        return bool(touched)

    def _place(self, pose: Pose) -> None:
        self.data.qpos[:2] = pose[:2]
        self.data.qpos[3:7] = np.cos(pose[2] / 2), 0, 0, np.sin(pose[2] / 2)


def _xml(cells: Array, cell: float, body: Body) -> str:
    """The model as text."""
    height, width = cell * cells.shape[0], cell * cells.shape[1]
    boxes = [(c * cell, r * cell, columns * cell, rows * cell) for r, c, rows, columns in rectangles(cells).tolist()]
    around = [
        (-DEPTH, -DEPTH, width + 2 * DEPTH, DEPTH), (-DEPTH, height, width + 2 * DEPTH, DEPTH),
        (-DEPTH, 0, DEPTH, height), (width, 0, DEPTH, height),
    ]  # fmt: skip
    radius, wheel = body.radius, WHEEL * body.radius
    ball = wheel / 2
    return MODEL.format(
        step=TICK / SUBSTEPS, extent=max(height, width), x=width / 2, y=height / 2,
        walls="\n    ".join(_box(*box) for box in (*boxes, *around)),
        wheel=wheel, radius=radius, half=radius / 2, middle=0.6 * radius, skin=1.5 * radius,
        inertia=2.5 * radius**2, gain=GAIN * wheel**2, axle=f'axis="0 1 0" armature="{ROTOR * wheel**2}"',
        nose=radius / 2, roof=1.1 * radius, ball=ball, front=CASTER * radius, low=ball - wheel + HUNG,
        out=TRACK * radius / 2, tyre=f'type="ellipsoid" size="{wheel} {wheel / 3} {wheel}" mass=".5" friction="1"',
    )  # fmt: skip


def _box(x: float, y: float, wide: float, high: float) -> str:
    size, pos = f"{wide / 2} {high / 2} {HEIGHT / 2}", f"{x + wide / 2} {y + high / 2} {HEIGHT / 2}"
    return f'<geom type="box" size="{size}" pos="{pos}" contype="2" conaffinity="2" friction="0.1" rgba=".3 .3 .3 1"/>'
