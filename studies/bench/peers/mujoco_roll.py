"""The rigid hoop in MuJoCo: a sphere on a plane, elliptic cone.

Its contact is a spring with a time constant of some steps, so that the step alone goes to its limit. Its cone is
convex: a point that slides is lifted at mu times its slip velocity, more than the spring holds back, so that it touches
in a few of a hundred steps only.
"""

from __future__ import annotations

from math import cos, sin

import numpy as np

from .rigid_pulse import Start, States

STEPS = (4e-5, 1e-5, 2.5e-6)

MODEL = """
<mujoco>
  <option gravity="0 0 -1" timestep="{step}" cone="elliptic" impratio="{impratio}" integrator="implicitfast"
          solver="Newton" tolerance="1e-14" iterations="200">
    <flag eulerdamp="disable"/>
  </option>
  <worldbody>
    <geom type="plane" size="0 0 1" friction="{mu} 0 0" condim="3" solref="{time} 1" solimp="{least} {most} 1e-6"/>
    <body pos="0 0 1">
      <joint name="x" type="slide" axis="1 0 0"/>
      <joint name="z" type="slide" axis="0 0 1"/>
      <joint name="turn" type="hinge" axis="0 1 0"/>
      <inertial pos="{x} 0 {z}" mass="1" diaginertia="{gyration} {gyration} {gyration}"/>
      <geom type="sphere" size="1" friction="{mu} 0 0" condim="3" solref="{time} 1" solimp="{least} {most} 1e-6"/>
    </body>
  </worldbody>
</mujoco>
"""


def pulse(start: Start, step: float, stiff: float) -> States:
    """States of a pulse; ``stiff`` is the contact's time constant in steps.

    Raises
    ------
    ImportError
        MuJoCo is not installed.
    """
    import mujoco

    x, z = start.e * sin(start.phi), start.e * cos(start.phi)
    model = mujoco.MjModel.from_xml_string(
        MODEL.format(
            step=step, impratio=100, mu=start.mu, time=stiff * step, least=0.99, most=0.9999, x=x, z=z,
            gyration=start.gyration,
        )
    )  # fmt: skip
    data = mujoco.MjData(model)
    data.qvel[:] = start.slip + start.omega, 0.0, start.omega
    rows = []
    low = max(start.edges) if start.omega > 0 else min(start.edges)
    for _ in range(round(start.duration / step)):
        rows.append((data.time, start.phi + data.qpos[2], data.qvel[2], data.qvel[0], data.qvel[1]))
        if (rows[-1][1] - low) * start.omega > 0:
            break
        mujoco.mj_step(model, data)
    return States(*np.array(rows).T)
