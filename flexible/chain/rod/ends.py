"""Ends of the rod at the weld: what is left there when the rod is taken from the mesh.

The mesh was cut some walls behind the weld, where what the weld does to the wall has faded. The rod is taken off from
there to the first section of the chain, and what is left is that section's compliance: the first part's and the joint's
with the weld, in which all that fades is gathered. That part bends easier one way than the other, and the easier the
further: its energy of third and of fourth order is what makes that section move as the mesh's does, to third order.
"""

from __future__ import annotations

from itertools import permutations
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .orders import Known, SecondOrder, fourth_order, second_order
from .section import RodCompliance, radial, transfer

Array = NDArray[np.float64]

SEEN = 0.0045  # a wall over R: in thinner ones the third order of a displacement is lost in rounding
KNOWN = 0.4  # of the stresses of third order may be left; a wall's own softening is nearer to those of coarser quads
MIRROR = np.diag([1.0, -1.0, -1.0])  # of displacement (y1, y2) and rotation, or of force and moment
BACK = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]])  # of strains: the angles change places and signs


class Ends(NamedTuple):
    """The first and the last part of a chain, at E b = 1.

    Attributes
    ----------
    local : (6, 6) array
        Stiffness in (e, tau_1, tau_2) of the first part, and of the last.
    bow : (2, 2, 2) array
        Second derivatives of the stretch of their lines by their angles.
    bent : (2, 3, 3, 3) array
        Third derivatives of their energy by (x, tau_1, tau_2), x that stretch.
    far : (2, 3, 3, 3, 3) array
        Fourth derivatives; zero where the mesh is too coarse to know them.
    """

    local: Array
    bow: Array
    bent: Array
    far: Array


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


def ends(compliance: RodCompliance, weld: float, first: float) -> Ends:
    """Those of a chain whose first section behind the ``weld`` is at ``first``, the last as far before it."""
    a = compliance.radius
    place = a * np.array([radial(angle) for angle in (weld, first, 2 * pi - first, 2 * pi - weld)])
    by = np.zeros((6, 6))
    by[:3, :3], by[3:, 3:] = chord_strains(place[0], place[1], 2), chord_strains(place[2], place[3], 1)
    local = in_strains(_at(compliance, first), by)

    own = in_strains(_at(compliance, first)[:3, :3], by[:3, :3])  # no force on the other one
    third = _evened(third_of(second_order(compliance, first), own, by[:3, :3], place[1] - place[0]))
    # by the force along the chord, not the elongation
    forced = np.eye(3)
    forced[0] = np.array([1.0, -own[0, 1], -own[0, 2]]) / own[0, 0]
    third = _by(third, forced)
    bow = third[0, 1:, 1:].copy()
    third[0, 1:, 1:] = third[1:, 0, 1:] = third[1:, 1:, 0] = 0.0
    bent = _by(third, np.array([own[0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))
    far, left = fourth_order(compliance, first, Known(own, bow, bent, place[1] - place[0], by[:3, :3]))
    far *= left < KNOWN and 1 - compliance.ring.mesh.inner / compliance.ring.mesh.outer > SEEN
    back = np.einsum("abcd,ai,bj,ck,dl->ijkl", far, BACK, BACK, BACK, BACK)
    return Ends(
        local, np.stack([bow, bow[::-1, ::-1]]), np.stack([bent, _by(bent, BACK)]), np.stack([far, back])
    )  # fmt: skip


def third_of(answers: SecondOrder, own: Array, by: Array, chord: Array) -> Array:
    """Third derivatives of a part's energy by its strains that make its section answer so.

    A section that moves by d lengthens the chord by (n.d)^2/2l to second order and turns either angle by
    (n.d)(t.d)/l^2; the stress of that and what these terms make of the linear stress are the chain's by its geometry.

    Parameters
    ----------
    answers : SecondOrder
        Of the section behind the part.
    own : (3, 3) array
        Stiffness of the part in (e, tau_1, tau_2).
    by : (3, 3) array
        These strains by the section's coordinates.
    chord : (2,) array

    Returns
    -------
    (3, 3, 3) array
        The stress first. That it is the same in all orders of its indices, for a potential's, is not made so here.
    """
    way = np.linalg.inv(by)
    load = by.T @ own
    # the means of a section's points are not quite what its loads do work on, from which the compliance is
    same = way @ np.linalg.inv(own) @ way.T @ np.linalg.inv(answers.first)
    second = np.einsum("ia,abc,bj,ck->ijk", by @ same, answers.second, load, load)
    moment = load.T @ answers.moment @ load

    length = float(np.hypot(*chord))
    along, across = chord @ way[:2] / length, np.array([-chord[1], chord[0]]) @ way[:2] / length
    turned = (np.outer(across, along) + np.outer(along, across)) / length**2
    geometric = np.stack([np.outer(across, across) / length, turned, turned])
    stress = np.multiply.outer(way[2], moment) - np.einsum("ai,ijk->ajk", own, second + geometric / 2)
    steered = np.einsum("ij,ika->ajk", own, geometric)
    return np.asarray(2 * stress - steered - steered.transpose(0, 2, 1))


def _piece(compliance: RodCompliance, one: float, two: float) -> Array:
    """Compliance of the section at ``two`` of the rod that is held at ``one``."""
    c, s = cos(one), sin(one)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(turn @ compliance.piece(two - one) @ turn.T)


def _at(compliance: RodCompliance, theta: float) -> Array:
    """(6, 6) compliance of the sections at ``theta`` and its mirror image, the rod behind them taken off."""
    rod, back = np.zeros((6, 6)), np.zeros((6, 6))
    piece = _piece(compliance, theta, compliance.weld)
    away = np.linalg.inv(transfer(compliance.radius, theta, compliance.weld))
    rod[:3, :3], rod[3:, 3:] = piece, MIRROR @ piece @ MIRROR
    back[:3, :3], back[3:, 3:] = away, MIRROR @ away @ MIRROR
    return np.asarray(back @ (compliance.ends - rod) @ back.T)


def _by(third: Array, change: Array) -> Array:
    """A form of third order by other variables."""
    return np.asarray(np.einsum("abc,ai,bj,ck->ijk", third, change, change, change))


def _evened(third: Array) -> Array:
    """A form of third order, the same in all orders of its indices."""
    return np.asarray(sum(third.transpose(order) for order in permutations(range(3))) / 6)
