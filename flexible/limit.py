"""The rigid hoop that the flexible one becomes as its stiffness grows: it depends on where the contact law sticks.

``patch`` has its stick threshold on the patch's resultants, |F| <= mu_s N, which is the rigid law. ``brush`` has it at
every point, and a rolling patch then breaks away from its rear. With pressure p = 4 p_0 u (1 - u), u from 0 at the
leading to 1 at the trailing edge, and bristles stretched in proportion to the way from the leading edge, the points
with u < b stick and the rest slides when c b = 4 mu_s p_0 b (1 - b) at u = b; so

    F/N = 6 [c b^2/2 + mu * 4 p_0 (1/6 - b^2/2 + b^3/3)]/(4 p_0) = 3 mu_s (b^2 - b^3) + mu (1 - 3 b^2 + 2 b^3),

whatever the stiffness. Its largest value, at b = 2 (mu_s - mu)/(3 mu_s - 2 mu), is all that a rolling brush can carry:
its limit is the rigid hoop with that static coefficient.
"""

from __future__ import annotations

from rigid import Scene


def effective_mu_s(mu_s: float, mu: float) -> float:
    """Largest F/N of a rolling parabolic brush patch whose points break at ``mu_s`` p and slide at ``mu`` p."""
    if mu_s <= mu:
        return mu_s
    q = mu / mu_s
    b = 2 * (1 - q) / (3 - 2 * q)
    return max(mu, mu_s * (3 * (b**2 - b**3) + q * (1 - 3 * b**2 + 2 * b**3)))


def rigid_limit(scene: Scene) -> Scene:
    """The scene whose rigid motion is the limit of this one's flexible motion; another for a brush with mu_s > mu."""
    friction = scene.friction
    if scene.contact.law == "patch" or friction.mu_s == friction.mu:
        return scene
    return scene.replace(friction={"mu_s": effective_mu_s(friction.mu_s, friction.mu)})
