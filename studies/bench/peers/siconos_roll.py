"""The rigid hoop in Siconos: Moreau-Jean time stepping with Coulomb friction of one coefficient, R = m = g = 1.

Siconos is no package of pip: it belongs to the Python of the system it is installed on, which runs this file as a
program. Coordinates are those of the mass centre and phi. The rim's gap is a linear relation, made anew at the middle
of each step and closed: a hoop released from rest does not leave the floor.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from functools import cache
from math import cos, sin
from typing import Any

STEPS = (1e-3, 1e-4, 1e-5)
LONGEST = 9.5
Turns = list[tuple[float, float, float, float]]


@cache
def interpreter() -> str | None:
    """A Python that can import Siconos, this one or the system's; None if there is none."""
    for python in (sys.executable, shutil.which("python3", path=os.defpath)):
        if python:
            found = subprocess.run([python, "-I", "-c", "import siconos.kernel"], capture_output=True, check=False)
            if found.returncode == 0:
                return python
    return None


def roll_turns(k: float, mu: float, phi0: float, turns: int, step: float) -> tuple[Turns, float]:
    """Turns as (t, phi, slip velocity, energy), between steps by straight lines, and the processor time they took.

    Raises
    ------
    RuntimeError
        Siconos is not installed, or does not get there.
    """
    python = interpreter()
    if python is None:
        raise RuntimeError("no Python here can import siconos")
    told = [str(number) for number in (k, mu, phi0, turns, step)]
    done = subprocess.run([python, "-I", __file__, *told], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"siconos ended with {done.returncode}: {done.stderr.strip()[-200:]}")
    found = json.loads(done.stdout.splitlines()[-1])
    return [tuple(turn) for turn in found["turns"]], float(found["seconds"])


def _marched(k: float, mu: float, phi0: float, turns: int, step: float) -> Turns:
    """What the other Python does."""
    import numpy as np
    import siconos.kernel as siconos

    e, gyration = 1 - k, k * k / 2

    def rows(phi: float) -> Any:
        """Normal and slip velocity of the contact point per velocity of the coordinates."""
        return np.array([[0.0, 1.0, e * sin(phi)], [1.0, 0.0, -(1 + e * cos(phi))]])

    start = np.array([e * sin(phi0), 1 + e * cos(phi0), phi0])
    hoop = siconos.LagrangianDS(start, np.zeros(3), np.diag([1.0, 1.0, gyration]))
    hoop.setFExtPtr(np.array([0.0, -1.0, 0.0]))
    rim = siconos.LagrangianLinearTIR(rows(phi0), np.zeros(2))
    contact = siconos.Interaction(siconos.NewtonImpactFrictionNSL(0.0, 0.0, mu, 2), rim)
    system = siconos.NonSmoothDynamicalSystem(0.0, LONGEST)
    system.insertDynamicalSystem(hoop)
    system.link(contact, hoop)
    clock = siconos.TimeDiscretisation(0.0, step)
    march = siconos.TimeStepping(system, clock, siconos.MoreauJeanOSI(0.5), siconos.FrictionContact(2))
    found: Turns = []
    q, v = start, np.zeros(3)
    while march.hasNextEvent() and len(found) < turns:
        matrix = rows(q[2] + 0.5 * step * v[2])
        gap = -(matrix @ q)  # kept until the step is over: Siconos points to it
        rim.setCPtr(matrix)
        rim.setEPtr(gap)
        march.computeOneStep()
        q_new, v_new = np.array(hoop.q()), np.array(hoop.velocity())
        if v[2] * v_new[2] < 0 and march.nextTime() > 0.1:
            share = v[2] / (v[2] - v_new[2])
            phi, right = q[2] + share * (q_new[2] - q[2]), v[0] + share * (v_new[0] - v[0])
            up = v[1] + share * (v_new[1] - v[1])
            energy = 0.5 * (right**2 + up**2) + 1 + e * cos(phi)
            found.append((march.nextTime() - (1 - share) * step, float(phi), float(right), float(energy)))
        q, v = q_new, v_new
        march.nextStep()
    return found


if __name__ == "__main__":
    told = [float(number) for number in sys.argv[1:]]
    began = time.process_time()
    made = _marched(told[0], told[1], told[2], int(told[3]), told[4])
    print(json.dumps({"turns": made, "seconds": time.process_time() - began}))
