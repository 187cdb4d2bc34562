"""How a section near the weld moves under forces to second and to third order, on the quads of the mesh.

To first order it moves by v_a f_a under loads f, to second by v_ab f_a f_b more. The second-order fields solve
K u_ab = -r(u_a, u_b), r what Green's strain bears of the second order in the linear fields
(:mod:`flexible.chain.rod.wall`).

To third order it is followed along ways of loading, t f. Its displacement is a series in t; so are the strains of the
part before it, by geometry, and the stresses that do the work of the loads on it. What the stresses of third order are
more than those of an energy known to third order is linear in the fourth derivatives of the energy.
"""

from __future__ import annotations

from itertools import combinations_with_replacement, permutations, product
from math import factorial, prod
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...ring.fem import Ring
from .corotated import strains
from .section import RodCompliance
from .tangent import outwards
from .wall import Wall, crossed, wall_beside

Array = NDArray[np.float64]

_SMALL = 1e-5  # of a displacement that has the size 1: a wall's section turns by some thousandth
_STRAINED = 1e-3  # the largest turn on a way of loading
_STRETCHES = 2  # most often that the stretch is in a term of fourth order: of more nothing is seen in a wall that bends


class SecondOrder(NamedTuple):
    """What a section answers to a force (y1, y2) on it and a moment; symmetric in the two loads that are last.

    Attributes
    ----------
    first : (3, 3) array
        Its displacement (y1, y2) and rotation, by the load.
    second : (3, 3, 3) array
        The same to second order, by two loads.
    rim : (n_rim, 2, 3, 3) array
        Displacement of the rim's nodes to second order.
    moment : (3, 3) array
        By how much the moment about the displaced section is more than the load, by two loads.
    """

    first: Array
    second: Array
    rim: Array
    moment: Array


def second_order(compliance: RodCompliance, theta: float) -> SecondOrder:
    """Answers of the section at ``theta``, loaded by dead forces far behind it; found once."""
    return compliance.ring.once(_answers, compliance, theta)


def _answers(ring: Ring, compliance: RodCompliance, theta: float) -> SecondOrder:
    wall = wall_beside(compliance, theta)
    size = np.abs(wall.fields).max(axis=0)
    fields = wall.fields / size
    moved, borne = ([wall.at_nodes(u) for u in each.T] for each in (fields, wall.linear(fields)))
    first = np.stack([wall.line.mean(u) for u in moved], axis=1)
    second, moment = np.empty((3, 3, 3)), np.empty((3, 3))
    rim = np.empty((len(ring.mesh.rim_theta), 2, 3, 3))

    def even(u: Array) -> Array:
        """What a section's place has of second order in a displacement, twice."""
        return np.asarray(wall.line.place(_SMALL * u) + wall.line.place(-_SMALL * u)) / _SMALL**2

    for a in range(3):
        for b in range(a + 1):
            bent = wall.at_nodes(wall.second[:, a, b] / (size[a] * size[b]))
            turned = (even(moved[a] + moved[b]) - even(moved[a] - moved[b])) / 8
            second[:, a, b] = second[:, b, a] = wall.line.mean(bent) + turned
            rim[..., a, b] = rim[..., b, a] = bent[ring.mesh.rim_nodes]
            one = crossed(moved[a] - first[:2, a], borne[b]).sum()
            moment[a, b] = moment[b, a] = (one + crossed(moved[b] - first[:2, b], borne[a]).sum()) / 2
    both = np.outer(size, size)
    return SecondOrder(first * size, second * both, rim * both, moment * both)


class Known(NamedTuple):
    """What is known of the part before the section: its energy by (x, tau_1, tau_2), to third order.

    Attributes
    ----------
    own : (3, 3) array
        Stiffness, no force on the section at the other end of the ring.
    bow : (2, 2) array
        Second derivatives of the stretch of its line by its angles.
    third : (3, 3, 3) array
        Third derivatives of the energy.
    chord : (2,) array
    by : (3, 3) array
        Linear strains by the section's coordinates.
    """

    own: Array
    bow: Array
    third: Array
    chord: Array
    by: Array


def fourth_order(compliance: RodCompliance, theta: float, known: Known) -> tuple[Array, float]:
    """Fourth derivatives (3, 3, 3, 3) of the energy of the part before the section at ``theta``.

    By least squares from ways of loading on all sides. The second number is what is left of the stresses of third
    order, over the largest of them: of those of an energy nothing would be.
    """
    wall = wall_beside(compliance, theta)
    mean = np.stack([wall.line.mean(wall.at_nodes(u)) for u in wall.fields.T], axis=1)
    # a section's mean is not quite what its loads do work on, from which the compliance is
    same = np.linalg.inv(known.by.T @ known.own @ known.by) @ np.linalg.inv(mean)
    # loads as those that bend a wall: forces as large as the moments over the length
    size = 1 / np.sqrt(np.diag(np.linalg.inv(known.own)))
    size[0] = size[2] / np.hypot(*known.chord)
    terms = [term for term in combinations_with_replacement(range(3), 4) if term.count(0) <= _STRETCHES]
    powers = np.array([[term.count(i) for i in range(3)] for term in terms])
    rows, right = [], []
    for way in product((-1.0, 0.0, 1.0), repeat=3):
        if way > (0.0, 0.0, 0.0):  # the way back has the same terms of third order, with the other sign
            strain, stress = _along(wall, known, same, known.by.T @ (np.array(way) / np.linalg.norm(way) * size))
            left = stress[2] - known.own @ strain[2] - np.einsum("abc,b,c", known.third, strain[0], strain[1])
            rows.append(_slopes(strain[0], powers) / size)
            right.append(left / size)
    matrix, stresses = np.concatenate(rows, axis=1).T, np.concatenate(right)
    scale = np.abs(matrix).max(axis=0)
    factors = np.linalg.lstsq(matrix / scale, stresses, rcond=None)[0] / scale
    fourth = np.zeros((3, 3, 3, 3))
    for term, power, factor in zip(terms, powers, factors, strict=True):
        for place in permutations(term):
            fourth[place] = factor * prod(map(factorial, power))
    return fourth, float(np.abs(matrix @ factors - stresses).max() / np.abs(stresses).max())


def _slopes(strain: Array, powers: NDArray[np.int64]) -> Array:
    """Derivatives (terms, 3) of products of powers of the strains by these."""
    slopes = np.empty(powers.shape)
    for a in range(3):
        less = powers.copy()
        less[:, a] = np.maximum(less[:, a] - 1, 0)
        slopes[:, a] = powers[:, a] * np.prod(strain**less, axis=1)
    return slopes


def _along(wall: Wall, known: Known, same: Array, load: Array) -> tuple[Array, Array]:
    """Strains (x, tau_1, tau_2) and stresses along a way of loading: their factors of t, t^2 and t^3, (3, 3) each."""
    one = wall.fields @ load
    two = wall.second @ load @ load
    three = -wall.under(2 * wall.square(one, two) + wall.cube(one))
    fields, borne = np.stack([wall.at_nodes(u) for u in (one, two, three)]), wall.at_nodes(wall.linear(one))
    length, by = float(np.hypot(*known.chord)), np.empty((3, 3))
    part = SimpleNamespace(chord=np.array([[*known.chord, length]]), bow=known.bow[None])

    def both(t: float) -> Array:
        u = np.tensordot(t ** np.arange(1, 4), fields, 1)
        d = wall.line.place(u)
        moment = t * (load[2] + crossed(u - d[:2], borne).sum())
        q = np.stack([np.zeros(3), same @ d])
        outwards(part, q, 0, 0, by)
        return np.concatenate([strains(part, q, 0)[3:6], np.linalg.solve(by.T, [t * load[0], t * load[1], moment])])

    turns = known.by @ same @ wall.line.mean(fields[0]) / [length, 1, 1]
    steps = np.array([-4, -3, -2, -1, 1, 2, 3, 4]) * (_STRAINED / 4 / np.abs(turns).max())
    values = np.stack([both(t) for t in steps])
    powers = np.arange(1, len(steps) + 1)
    scaled = np.linalg.solve((steps[:, None] / steps[-1]) ** powers, values)
    factors = scaled[:3] / steps[-1] ** powers[:3, None]
    return factors[:, :3], factors[:, 3:]
