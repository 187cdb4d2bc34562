"""The rigid hoop that the flexible one should become: which it is depends on where the contact law sticks.

A stick threshold on the patch's resultants is the rigid law. One at every point of the patch lets it break
away from its rear, so its largest F/N is less than mu_s, and its limit is the rigid hoop with that smaller
coefficient.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from rigid import Motion, Pulse, Release, Run, Scene, simulate


def effective_mu_s(mu_s: float, mu: float) -> float:
    """Largest F/N of a rolling parabolic brush patch whose points break at mu_s p and slide at mu p.

    With a share 1 - b of its length sliding F/N is 3 mu_s (b^2 - b^3) + mu (1 - 3 b^2 + 2 b^3), largest at
    b = 2 (mu_s - mu)/(3 mu_s - 2 mu).
    """
    if mu_s == mu:
        return mu
    b = 2 * (mu_s - mu) / (3 * mu_s - 2 * mu)
    return 3 * mu_s * (b**2 - b**3) + mu * (1 - 3 * b**2 + 2 * b**3)


def limit_mu_s(scene: Scene) -> float:
    """Static coefficient of the rigid hoop that the scene's contact law tends to."""
    friction = scene.friction
    return friction.mu_s if scene.contact.law == "patch" else effective_mu_s(friction.mu_s, friction.mu)


def tended(scene: Scene, *, history: bool = False, progress: Callable[[float], None] | None = None) -> Motion:
    """The rigid motion that a flexible scene tends to, a solver like any other.

    For a brush with mu_s > mu it begins with the first pulse: there, with ``resolve = "pulses"``, the
    flexible hoop takes over from the rigid one, which until then moved with mu_s. The pulse is measured over
    the interval of phi that the rigid hoop with mu_s has N > M g in, as the flexible hoop's is.
    """
    paper = simulate(scene)
    mu_s = limit_mu_s(scene)
    if mu_s == scene.friction.mu_s or not paper.pulses:
        return paper
    window = paper.pulses[0]
    release, length = scene.release, window.t_end
    if scene.solve.resolve == "pulses":
        state = paper.at(window.t_start)
        release = Release(float(state.phi), float(state.omega), float(state.slip_velocity))
        length -= window.t_start
    changed = scene.replace(friction={"mu_s": mu_s}, release=release, run=Run(t_end=1.5 * length))
    motion = simulate(changed)
    return replace(motion, scene=scene, pulses=(over(motion, window.phi_start, window.phi_end),))


def over(motion: Motion, phi_start: float, phi_end: float) -> Pulse:
    """The first pulse of a rigid motion measured over another interval of phi, by what it changed.

    Impulses are changes of momentum, the loss is the change of energy; peak and restitution stay the pulse's
    own.
    """
    pulse = motion.pulses[0]
    middle, length = 0.5 * (pulse.t_start + pulse.t_end), pulse.t_end - pulse.t_start
    start = _passes(motion, phi_start, max(0.0, middle - length), middle)
    end = _passes(motion, phi_end, middle, min(motion.t_end, middle + length))
    hoop = motion.scene.hoop
    states = motion.at(np.array([start, end]))
    x_dot = states.slip_velocity + hoop.R * states.omega * (1 + hoop.e * np.cos(states.phi))
    y_dot = -hoop.R * hoop.e * np.sin(states.phi) * states.omega
    return replace(
        pulse,
        t_start=start,
        t_end=end,
        phi_start=phi_start,
        phi_end=phi_end,
        normal_impulse=hoop.total_mass * float(y_dot[1] - y_dot[0] + hoop.g * (end - start)),
        friction_impulse=hoop.total_mass * float(x_dot[1] - x_dot[0]),
        friction_loss=float(states.energy[0] - states.energy[1]),
    )


def _passes(motion: Motion, phi: float, early: float, late: float) -> float:
    """Time between two at which the angle is ``phi``, or the nearer end where it is not reached."""

    def off(t: float) -> float:
        return float(motion.at(t).phi) - phi

    if off(early) * off(late) >= 0:
        return early if abs(off(early)) < abs(off(late)) else late
    return float(brentq(off, early, late, xtol=1e-15, rtol=1e-15))
