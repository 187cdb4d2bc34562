"""Ends of the rod at the weld: what is left there when the rod is taken from the mesh.

The mesh was cut some walls behind the weld, where what the weld does to the wall has faded. The rod is taken off from
there to the first section of the chain, and what is left is that section's compliance: the first part's and the joint's
with the weld, in which all that fades is gathered. Of the energy of third order, by which a part bends easier one way
than the other, that of the mesh less what the chain has by its geometry is left in the same way.
"""

from __future__ import annotations

from itertools import pairwise, permutations
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .section import RodCompliance, radial

Array = NDArray[np.float64]

BETWEEN = 8  # parts of the rod from the first section to the cut, of whose energy it is told what the chain has
_MIRROR = np.diag([1.0, -1.0, -1.0])  # of displacement (y1, y2) and rotation, or of force and moment


class Ends(NamedTuple):
    """The first and the last part of a chain, at E b = 1.

    Attributes
    ----------
    local : (6, 6) array
        Stiffness in (e, tau_1, tau_2) of the first part, and of the last.
    bow : (2, 2, 2) array
        Second derivatives of the stretch of their lines by their angles.
    bent : (2, 2, 2, 2) array
        Third derivatives of their energy by their angles.
    """

    local: Array
    bow: Array
    bent: Array


def chord_strains(one: Array, two: Array, moves: int) -> Array:
    """(3, 3): (e, tau_1, tau_2) of a part by the coordinates of its section 1 or 2, the other one held."""
    along = two - one
    length = float(np.hypot(*along))
    t1, t2 = along / length
    sign = 2 * moves - 3
    return np.array(
        [
            [sign * t1, sign * t2, 0.0],
            [sign * t2 / length, -sign * t1 / length, 2.0 - moves],
            [sign * t2 / length, -sign * t1 / length, moves - 1.0],
        ]
    )


def in_strains(compliance: Array, by: Array) -> Array:
    """Stiffness in the strains that coordinates make, from the compliance of these coordinates."""
    inverse = np.linalg.inv(by)
    stiffness = inverse.T @ np.linalg.inv(compliance) @ inverse
    return (stiffness + stiffness.T) / 2


def bending(local: Array) -> float:
    """Stiffness of a part against tau_2 - tau_1."""
    return float(local[1, 1] + local[2, 2] - 2 * local[1, 2]) / 4


def bow_of(local: Array, chord: float) -> Array:
    """Second derivatives, by its angles, of what a part of some stiffness is longer than its chord.

    Its line bends to one side and back by l tau^2/10, less where it shears instead, and evenly by l (2 tau)^2/24.
    """
    bends = float(local[1, 1] + local[2, 2] + 2 * local[1, 2]) / (12 * bending(local))
    back, even = bends**2 * chord / 20, chord / 12
    return np.array([[back + even, back - even], [back - even, back + even]])


def pulled_of(local: Array, chord: float, poisson: float) -> float:
    """Bending stiffness that comes with the stretch of a part's line."""
    return 3 * (1 - poisson) * bending(local) / chord


def is_jointed(compliance: RodCompliance, weld: float, wall: float) -> bool:
    """Whether the rod can be taken off as far as the weld: the joint that is left there gives way to any load.

    Of long quads in a thin wall there is less left than none: they lack energy of the shear force, see ``section``.
    """
    unit = np.array([1.0, 1.0, wall])
    joint = _at(compliance, weld)[:3, :3]
    return bool(np.linalg.eigvalsh(joint * np.outer(unit, unit))[0] > 0)


def ends(compliance: RodCompliance, weld: float, first: float, poisson: float) -> Ends:
    """Those of a chain whose first section behind the ``weld`` is at ``first``, the last as far before it."""
    a = compliance.radius
    place = a * np.array([radial(angle) for angle in (weld, first, 2 * pi - first, 2 * pi - weld)])
    by = np.zeros((6, 6))
    by[:3, :3], by[3:, 3:] = chord_strains(place[0], place[1], 2), chord_strains(place[2], place[3], 1)
    local = in_strains(_at(compliance, first), by)

    begin = _at(compliance, first)[:3, :3] @ _transfer(a, first, compliance.weld).T
    strains = by[:3, :3] @ begin
    own = in_strains(_at(compliance, first)[:3, :3], by[:3, :3])  # no force on the other one
    held = np.zeros((3, 3))
    known = _geometric(own, (place[0], place[1]), held, begin) + _of_rod(compliance, first, begin, poisson)
    third = 6 * _by(np.asarray(compliance.bent - known), np.asarray(np.linalg.inv(strains)))
    # by the force along the chord and the angles; terms of that force's square are none to speak of
    change = np.eye(3)
    change[0] = np.array([1.0, -own[0, 1], -own[0, 2]]) / own[0, 0]
    third = _by(third, change)
    bow, bent = third[0, 1:, 1:], third[1:, 1:, 1:]
    # mirrored, the angles change places and signs
    return Ends(local, np.stack([bow, bow[::-1, ::-1]]), np.stack([bent, -bent[::-1, ::-1, ::-1]]))


def _transfer(radius: float, one: float, two: float) -> Array:
    """What the section at ``two`` moves with that at ``one``; transposed, the forces at ``one`` of those at ``two``."""
    arm = radius * (radial(two) - radial(one))
    return np.array([[1.0, 0.0, -arm[1]], [0.0, 1.0, arm[0]], [0.0, 0.0, 1.0]])


def _piece(compliance: RodCompliance, one: float, two: float) -> Array:
    """Compliance of the section at ``two`` of the rod that is held at ``one``."""
    c, s = cos(one), sin(one)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(turn @ compliance.piece(two - one) @ turn.T)


def _at(compliance: RodCompliance, theta: float) -> Array:
    """(6, 6) compliance of the sections at ``theta`` and its mirror image, the rod behind them taken off."""
    rod, back = np.zeros((6, 6)), np.zeros((6, 6))
    piece = _piece(compliance, theta, compliance.weld)
    away = np.linalg.inv(_transfer(compliance.radius, theta, compliance.weld))
    rod[:3, :3], rod[3:, 3:] = piece, _MIRROR @ piece @ _MIRROR
    back[:3, :3], back[3:, 3:] = away, _MIRROR @ away @ _MIRROR
    return np.asarray(back @ (compliance.ends - rod) @ back.T)


def _by(third: Array, change: Array) -> Array:
    """A form of third order by other variables, the same in all orders of its indices."""
    form = np.einsum("abc,ai,bj,ck->ijk", third, change, change, change)
    return np.asarray(sum(form.transpose(order) for order in permutations(range(3))) / 6)


def _geometric(local: Array, place: tuple[Array, Array], one: Array, two: Array, bow: Array | None = None) -> Array:
    """Energy of third order, by three loads, of what strains of a part have of the second order, on its linear stress.

    Of the chord's elongation that is (n.d)^2/(2 l), of the angles (n.d)(t.d)/l^2, of the line what it bows besides.
    """
    length = float(np.hypot(*(place[1] - place[0])))
    t = (place[1] - place[0]) / length
    strains = chord_strains(*place, 1) @ one + chord_strains(*place, 2) @ two
    stress, d = local @ strains, (two - one)[:2]
    along, across = t @ d, np.array([-t[1], t[0]]) @ d
    turned = (np.outer(across, along) + np.outer(along, across)) / (2 * length**2)
    longer = np.outer(across, across) / (2 * length)
    if bow is not None:
        longer = longer + strains[1:].T @ bow @ strains[1:] / 2
    return np.multiply.outer(stress[0], longer) + np.multiply.outer(stress[1] + stress[2], turned)


def _of_rod(compliance: RodCompliance, first: float, begin: Array, poisson: float) -> Array:
    """Energy of third order of the rod from the section at ``first``, which moves by ``begin``, to the cut."""
    a, total = compliance.radius, np.zeros((3, 3, 3))
    if compliance.weld - first < 1e-9:
        return total
    angles = np.linspace(first, compliance.weld, BETWEEN + 1)
    for one, two in pairwise(angles.tolist()):
        place = (a * radial(one), a * radial(two))
        piece, chord = _piece(compliance, one, two), float(np.hypot(*(place[1] - place[0])))
        end = _transfer(a, one, two) @ begin + piece @ _transfer(a, two, compliance.weld).T
        local = in_strains(piece, chord_strains(*place, 2))
        total += _geometric(local, place, begin, end, bow_of(local, chord))
        stretch, tau_1, tau_2 = chord_strains(*place, 1) @ begin + chord_strains(*place, 2) @ end
        bend = np.outer(tau_2 - tau_1, tau_2 - tau_1)
        total += pulled_of(local, chord, poisson) / 2 * np.multiply.outer(stretch, bend)
        begin = end
    return total
