"""Scenes and marches that several tests share."""

from math import pi

import numpy as np

from flexible.contact.points.data import NOTHING, no_bristles
from flexible.models.state import Touching, in_motion
from flexible.start.pose import pose_of
from flexible.time.adaptive import Limits, march
from flexible.time.events import Ends
from flexible.time.methods import ESDIRK3
from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene, Solve
from rigid.output.units import without_units

#: the hoop of the paper's sec. 3.3, on a floor soft enough to be quick
HOOP = Scene(
    Hoop(k=0.1, r=1.02, mass_ratio=0.1),
    Friction(0.35, 0.3),
    Release(10 * pi / 180),
    Run(until="pulse"),
    ring=Ring(bending_stiffness=1e3),
    contact=Contact(stiffness=1e8, damping=0.0),
    solve=Solve(rtol=1e-3, level="reduced"),
)


def pose_at(motion, t, side="right"):
    """The rigid motion at time ``t``, without its units; where phases meet, in the one that ``side`` says."""
    return pose_of(without_units(motion.at(t, side), motion.scene), motion.phase_at(t, side).kind)


def flying(hoop, pos, vel):
    """A hoop off the floor."""
    window = hoop.window(pos[2], 0.0, 0.0, 0.1 * hoop.element)
    u = np.zeros((2 * window[1] + 1, 2))
    nothing = (u, np.zeros_like(u), NOTHING, no_bristles())
    return in_motion(0.0, 0.0, (pos, vel, np.zeros_like(pos)), 0, Touching(window, *nothing), 0.0)


def steps_of(hoop, state, t_end, step, method=ESDIRK3):
    """March in equal steps; the last state, the records and the states."""
    states = []
    count = round((t_end - state.t) / step)
    length = (t_end - state.t) / count * (1 + 1e-12)
    last, records, _, ended, _ = march(
        hoop, state, Ends(t=t_end), 0.5, Limits(length, length), keep=states.append, methods=method
    )
    assert not ended, ended
    return last, records, states


def energy(record):
    """Energy held at a record."""
    return record.kinetic + record.gravity + record.ring_strain + record.contact_spring
