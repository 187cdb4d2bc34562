"""The ring and the patch at rest in the disk's frame, or as they come, under the forces of a rigid pose."""

from __future__ import annotations

from math import ceil, cos, pi, sin

import numpy as np

from rigid import Kind

from ..contact.points.data import NOTHING, no_bristles
from ..models.equilibrium import Patch
from ..models.select import Hoop
from ..models.state import State, Touching, in_motion
from ..output.body import lowest
from ..time.adaptive import MarchError, compile_steps, restart
from ..time.course import Stop
from .pose import Pose
from .settling import settle, settle_free


def equilibrium(hoop: Hoop, pose: Pose, t: float = 0.0, x_C: float = 0.0, near: State | None = None) -> State:
    """The ring and the patch at rest in the disk's frame under the forces of a rigid pose; ``near`` may be one like it.

    Raises
    ------
    MarchError
        No equilibrium was found: the ring is too soft to carry these forces.
    """
    s, c = sin(pose.phi), cos(pose.phi)
    a_x, a_y, angular = pose.accelerations(hoop)
    weight = pose.normal_force / (1 + hoop.scene.hoop.mass_ratio)
    lost = f": no equilibrium of the ring was found under N = {weight:.4g} of the weight of disk and hoop"
    zero = np.zeros(3 + hoop.coordinates)
    mode = hoop.law.start(pose.kind)
    try:
        ring = hoop.resting(pose.omega, angular, a_x * s + a_y * c, a_x * c - a_y * s)
    except np.linalg.LinAlgError:
        raise MarchError(Stop(lost, phi=pose.phi, what="no start")) from None
    if pose.normal_force <= 0:
        window = hoop.window(pose.phi, 0.0, 0.0, 0.1 * hoop.element)
        u = settle_free(ring, window)
        if u is None:
            lost = ": no shape of the ring was found that its own inertia leaves at rest as it flies"
            raise MarchError(Stop(lost, phi=pose.phi, what="no start", by_ring=True))
        pos = np.concatenate([[0.0, pose.height, pose.phi], ring.coordinates])
        nothing = (np.zeros_like(u), NOTHING, no_bristles())
        state = in_motion(t, x_C, (pos, zero, zero), mode, Touching(window, u, *nothing), pose.slip_velocity)
        # as high over the floor, wherever its rim is lowest, as the rigid hoop is
        pos[1] += pose.height - lowest(hoop, state)
        return state._replace(pos=pos)
    patch = Patch(hoop, pose.phi, pose.normal_force, pose.friction_force)
    if near is not None and near.res.normal > 0:
        patch.start_from(near)
    reached = settle(ring, patch)
    if reached < 1:
        lost += f": from no load on, it is lost at {reached * weight:.3g} of it"
        if reached > 0:  # as much stiffer it bends as it does under that share, but for the foundation's part
            lost += f"; a ring {ceil(100 / reached) / 100:g} times as stiff would carry it"
        raise MarchError(Stop(lost, phi=pose.phi, what="no start", by_ring=reached == 0))
    pos = np.concatenate([[0.0, patch.height, pose.phi], ring.coordinates])
    rim = Touching(patch.window, patch.u, patch.nodal, patch.res, patch.bristles)
    return in_motion(t, x_C, (pos, zero, zero), mode, rim, pose.slip_velocity)


def _unstrained(hoop: Hoop, pose: Pose) -> State:
    """The unstrained ring touching the floor with one point, before its accelerations are known."""
    n = hoop.coordinates
    window = hoop.window(pose.phi, 0.0, 0.0, 0.1 * hoop.element)
    u = np.zeros((2 * window[1] + 1, 2))
    pos, vel = np.zeros(3 + n), np.zeros(3 + n)
    pos[2] = pose.phi
    vel[0], vel[2] = pose.slip_velocity, pose.omega
    # whether it will roll is for the friction to say: no phase is known yet
    kind = Kind.FLIGHT if pose.slip_velocity == 0 else Kind.SKID if pose.slip_velocity > 0 else Kind.SPIN
    mode = hoop.law.start(kind)
    rim = Touching(window, u, np.zeros_like(u), NOTHING, no_bristles())
    return in_motion(0.0, 0.0, (pos, vel, np.zeros(3 + n)), mode, rim, pose.slip_velocity)


def undeformed(hoop: Hoop, pose: Pose) -> State:
    """The unstrained ring touching the floor with one point, moving as the rigid hoop does."""
    state = _unstrained(hoop, pose)
    return restart(hoop, state, state.mode)


def compile_ahead(hoop: Hoop) -> None:
    """Have the steps of a hoop's level compiled, see :func:`flexible.time.adaptive.compile_steps`."""
    compile_steps(hoop, _unstrained(hoop, Pose(pi, 1.0, 0.0, 0.0, 0.0, Kind.ROLL)))
