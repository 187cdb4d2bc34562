"""Elasticity and rim of a chain of rod parts that turn and move far, in compiled code.

A *section* of the ring is rigid: it moves by (u1, u2) and turns by phi, all relative to the disk's frame. A *part*
between two sections is elastic. What deforms it is seen from its chord: the chord's elongation e and the angles that
its two sections make with it. In these three the part is linear, since each of many parts bends little; everything
else, however large the rotation, is geometry (corotational formulation, Crisfield 1990). Elongation and angles are made
from displacements, so that nothing cancels:

    e = (2 D.d + d.d)/(l' + l),   alpha = atan2(D x d, l^2 + D.d),   tau = phi - alpha,      d = u_2 - u_1.

Three terms are not linear. A part that bends is longer than its chord: its line is stretched by x = e + tau.B.tau/2, in
a thin part l (2 tau_1^2 - tau_1 tau_2 + 2 tau_2^2)/30 more than e; with it the chain is of the fourth order in its
parts.
And a part that is pulled bends harder. Of a wall with Green's strain in plane stress, stretched by eps and bent by
kappa, a fibre at z strains by eps + (1 + (1 - nu) eps) z kappa + (1 - nu) z^2 kappa^2/2 to second order (it gets
thinner as it is pulled, and its middle moves), so that bending costs 1 + 3 (1 - nu) eps times as much. Strains of a
hundredth, in a wall between disk and floor, change its stiffness by two. A part that bends far bends easier
(:mod:`flexible.chain.rod.softening`). A part at the weld, which holds one side of the wall alone, bends easier one way
than the other: there all three are the mesh's (:mod:`flexible.chain.rod.ends`).
"""

from __future__ import annotations

from math import atan2, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid.kernel.compile import jit, loop

from .softening import far_bent, softened

Array = NDArray[np.float64]


class Rod(NamedTuple):
    """A ring cut into n + 1 parts by n sections; the first and the last section, 0 and n + 1, are welded to the disk.

    Attributes
    ----------
    theta : (n + 2,) array
        Angle of each section, ascending from one end of the weld round to the other.
    place : (n + 2, 2) array
        Its centre of mass, undeformed.
    chord : (n + 1, 3) array
        The way from each section to the next, undeformed, and its length.
    local : (n + 1, 3, 3) array
        Stiffness of each part in (e, tau_1, tau_2).
    bow : (n + 1, 2, 2) array
        Second derivatives of the stretch of each part's line by its angles.
    pulled : (n + 1,) array
        Bending stiffness of each part, in tau_2 - tau_1, that comes with x = 1.
    softening, strained : (n + 1,) arrays
        Bending stiffness that each part loses as it bends far, and how far that is: see
        :mod:`flexible.chain.rod.softening`. Of the first and the last part the mesh has that.
    bent : (2, 3, 3, 3) array
        Third derivatives of the energy of the first and of the last part by (x, tau_1, tau_2).
    far : (2, 3, 3, 3, 3) array
        Fourth derivatives.
    fading : float
        1/U_s by which these fade.
    across : (3, 3) array
        Of the first part by the last one, through the wall over the weld.
    mass, turning : (n + 2,) arrays
        Mass of each section, and its moment of inertia about its centre of mass.
    curve : (n + 2, 3) array
        Weights that make dphi/dtheta at a section of phi of the one before, itself, the one behind.
    offset : float
        Of the rim from the centres of mass.
    pinch : float
        What the rim sinks where the ring bends by dphi/dtheta = 1, for a wall that is stretched gets thinner.
    reach : float
        Share of the first and the last part over which what bending makes of the rim at their sections dies out.
    seen : (n + 2, 2, 4, 3) array
        What the rim has at each section of the strains of the parts there: see :mod:`flexible.chain.rod.surface`.
    rooted : int
        Parts from the weld, on either side, whose rim is moved by what the weld does to the wall too.
    """

    theta: Array
    place: Array
    chord: Array
    local: Array
    bow: Array
    pulled: Array
    softening: Array
    strained: Array
    bent: Array
    far: Array
    fading: float
    across: Array
    mass: Array
    turning: Array
    curve: Array
    offset: float
    pinch: float
    reach: float
    seen: Array
    rooted: int


@loop
def chord(rod: Any, q: Any, p: int) -> tuple[float, float, float, float, float, float]:
    """Direction and length of a part's chord, and the three strains of the part."""
    a1, a2, rest = rod.chord[p, 0], rod.chord[p, 1], rod.chord[p, 2]
    d1, d2 = q[p + 1, 0] - q[p, 0], q[p + 1, 1] - q[p, 1]
    dot = a1 * d1 + a2 * d2
    x1, x2 = a1 + d1, a2 + d2
    now = sqrt(x1 * x1 + x2 * x2)
    share = 1 / now
    alpha = atan2(a1 * d2 - a2 * d1, rest * rest + dot)
    longer = (2 * dot + d1 * d1 + d2 * d2) / (now + rest)
    return x1 * share, x2 * share, now, longer, q[p, 2] - alpha, q[p + 1, 2] - alpha


@loop
def outward(t1: float, t2: float, now: float, end: int, i: int, k: int) -> float:
    """Derivative of the i-th strain of the first part, or with ``end`` = 1 of the last, by a coordinate of its section
    off the weld, for a chord of this direction and length."""
    if k == 2:
        return 0.0 if i == 0 else (i - 1.0 if end == 0 else 2.0 - i)
    value = (t1 if k == 0 else t2) if i == 0 else (t2 if k == 0 else -t1) / now
    return value if end == 0 else -value


@loop
def _product(local: Any, e: float, tau_1: float, tau_2: float) -> tuple[float, float, float]:
    s0 = local[0, 0] * e + local[0, 1] * tau_1 + local[0, 2] * tau_2
    s1 = local[1, 0] * e + local[1, 1] * tau_1 + local[1, 2] * tau_2
    s2 = local[2, 0] * e + local[2, 1] * tau_1 + local[2, 2] * tau_2
    return s0, s1, s2


@loop
def strains(rod: Any, q: Any, p: int) -> tuple[float, float, float, float, float, float, float, float]:
    """As :func:`chord`, but the stretch x of the line for its chord's; and the derivatives of x by the angles."""
    t1, t2, now, e, tau_1, tau_2 = chord(rod, q, p)
    bow = rod.bow[p]
    w1, w2 = bow[0, 0] * tau_1 + bow[0, 1] * tau_2, bow[1, 0] * tau_1 + bow[1, 1] * tau_2
    return t1, t2, now, e + (w1 * tau_1 + w2 * tau_2) / 2, tau_1, tau_2, w1, w2


@loop
def stiffer(third: Any, x: float, tau_1: float, tau_2: float) -> tuple[float, float, float, float, float, float]:
    """What strains add to the stiffness of a part at the weld: to the entries 00, 01, 02, 11, 12 and 22."""
    m00 = third[0, 0, 0] * x + third[0, 0, 1] * tau_1 + third[0, 0, 2] * tau_2
    m01 = third[0, 1, 0] * x + third[0, 1, 1] * tau_1 + third[0, 1, 2] * tau_2
    m02 = third[0, 2, 0] * x + third[0, 2, 1] * tau_1 + third[0, 2, 2] * tau_2
    m11 = third[1, 1, 0] * x + third[1, 1, 1] * tau_1 + third[1, 1, 2] * tau_2
    m12 = third[1, 2, 0] * x + third[1, 2, 1] * tau_1 + third[1, 2, 2] * tau_2
    m22 = third[2, 2, 0] * x + third[2, 2, 1] * tau_1 + third[2, 2, 2] * tau_2
    return m00, m01, m02, m11, m12, m22


@loop
def stress(rod: Any, p: int, x: float, tau_1: float, tau_2: float) -> tuple[float, float, float, float]:
    """Energy of a part with these strains, force along its line, and the moments at both ends without it."""
    s0, s1, s2 = _product(rod.local[p], x, tau_1, tau_2)
    pulled, bend = rod.pulled[p], tau_2 - tau_1
    less, moment, _ = softened(rod.softening[p], rod.strained[p], bend)
    pull = pulled * x * bend
    energy = (x * s0 + tau_1 * s1 + tau_2 * s2 + pull * bend) / 2 + less
    return energy, s0 + pulled * bend * bend / 2, s1 - pull - moment, s2 + pull + moment


@loop
def stress_at_weld(rod: Any, q: Any, p: int, x: float, tau_1: float, tau_2: float) -> tuple[float, float, float, float]:
    """The same of the first or the last part, which feel each other."""
    s0, s1, s2 = _product(rod.local[p], x, tau_1, tau_2)
    a = rod.across
    _, _, _, y, y1, y2, _, _ = strains(rod, q, rod.local.shape[0] - 1 - p)
    if p == 0:
        a0, a1, a2 = _product(a, y, y1, y2)
        s0 += a0
        s1 += a1
        s2 += a2
    else:
        s0 += a[0, 0] * y + a[1, 0] * y1 + a[2, 0] * y2
        s1 += a[0, 1] * y + a[1, 1] * y1 + a[2, 1] * y2
        s2 += a[0, 2] * y + a[1, 2] * y1 + a[2, 2] * y2
    m00, m01, m02, m11, m12, m22 = stiffer(rod.bent[min(p, 1)], x, tau_1, tau_2)
    h0 = m00 * x + m01 * tau_1 + m02 * tau_2
    h1 = m01 * x + m11 * tau_1 + m12 * tau_2
    h2 = m02 * x + m12 * tau_1 + m22 * tau_2
    energy = (x * s0 + tau_1 * s1 + tau_2 * s2) / 2 + (x * h0 + tau_1 * h1 + tau_2 * h2) / 6
    less, moment, _ = softened(rod.softening[p], rod.strained[p], tau_2 - tau_1)
    more, q0, q1, q2, _, _, _, _, _, _ = far_bent(rod.far[min(p, 1)], rod.fading, rod.local[p], x, tau_1, tau_2)
    return energy + less + more, s0 + h0 / 2 + q0, s1 + h1 / 2 + q1 - moment, s2 + h2 / 2 + q2 + moment


@jit
def elastic(rod: Any, q: Any, force: Any) -> float:
    """Strain energy of the chain; its forces are added.

    Parameters
    ----------
    rod : Rod
    q : (n + 2, 3) array
        Displacement and rotation of all sections; those of the weld are zero.
    force : (n + 2, 3) array
    """
    return _elastic(rod, q, force)


@loop
def _elastic(rod: Any, q: Any, force: Any) -> float:
    energy, last = 0.0, rod.local.shape[0] - 1
    for p in range(last + 1):
        t1, t2, now, x, tau_1, tau_2, w1, w2 = strains(rod, q, p)
        if 0 < p < last:
            own, s0, s1, s2 = stress(rod, p, x, tau_1, tau_2)
        else:
            own, s0, s1, s2 = stress_at_weld(rod, q, p, x, tau_1, tau_2)
        energy += own
        s1 += s0 * w1
        s2 += s0 * w2
        turn = (s1 + s2) / now
        f1, f2 = t1 * s0 + t2 * turn, t2 * s0 - t1 * turn
        force[p, 0] -= f1
        force[p, 1] -= f2
        force[p, 2] += s1
        force[p + 1, 0] += f1
        force[p + 1, 1] += f2
        force[p + 1, 2] += s2
    return energy


@loop
def strain_energy(rod: Any, q: Any) -> float:
    """Strain energy of the chain, see :func:`elastic`."""
    energy, last = 0.0, rod.local.shape[0] - 1
    for p in range(last + 1):
        _, _, _, x, tau_1, tau_2, _, _ = strains(rod, q, p)
        if 0 < p < last:
            energy += stress(rod, p, x, tau_1, tau_2)[0]
        else:
            energy += stress_at_weld(rod, q, p, x, tau_1, tau_2)[0]
    return energy


def bends_and_stretches(rod: Rod, q: Array) -> tuple[Array, Array]:
    """dphi/dtheta and elongation of the line of centres at the sections, (n + 2,) each; at the weld as next to it."""
    bend = np.zeros(len(q))
    bend[1:-1] = sum(rod.curve[1:-1, k] * q[k : len(q) - 2 + k, 2] for k in range(3))
    bend[0], bend[-1] = bend[1], bend[-2]
    lengths = np.hypot(*np.diff(rod.place, axis=0).T)
    strain = np.array([strains(rod, q, p)[3] for p in range(len(rod.local))]) / lengths
    inner = (strain[1:] + strain[:-1]) / 2
    return bend, np.concatenate([strain[:1], inner, strain[-1:]])
