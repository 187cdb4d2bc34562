"""What a scene's compliance becomes in the scaled problem, in which there is no stiffness left.

With eps = (eps_n R^2/(M g))^(-1/3), M the total mass, everything fast near an instant of the rigid motion lives on

    t = t* + eps tau,   psi = eps s,   h = eps^2 H,   v = eps V          (R = g = M = 1).
"""

from __future__ import annotations

from flexible.models.rim_contact import relaxation_time
from rigid import Scene


def epsilon(scene: Scene) -> float:
    """The small parameter of a scene: the inverse cube root of its foundation, in units of the total mass."""
    return float((scene.contact.stiffness / (1 + scene.hoop.mass_ratio)) ** (-1 / 3))


def theta_of(scene: Scene, damping: float | None = None) -> float:
    """The patch's relaxation time on the tau clock, at the scene's damping ratio or at another one.

    It is the only place where the damping ratio enters: everything else here knows theta alone.
    """
    ratio = scene.contact.damping if damping is None else damping
    return relaxation_time(scene.replace(contact={"damping": 1.0})) * ratio / epsilon(scene)


def damping_of(scene: Scene, theta: float) -> float:
    """The damping ratio that gives a relaxation time on the tau clock."""
    return theta / theta_of(scene, 1.0)
