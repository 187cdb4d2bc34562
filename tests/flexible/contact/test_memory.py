"""What bristles remember of a step in which their points came to the floor, of a wall whose dent changes meanwhile."""

from math import pi

import numpy as np
import pytest
from kinematic import VERTEX, parameters

from flexible.contact.forces import contact_forces
from flexible.contact.laws.patch import STICK
from flexible.contact.points.data import UNDAMPED, Before, Rim, no_bristles
from flexible.contact.points.rim import element_at

EPS, PHI, OMEGA, DEPTH, SPACING = 1e6, 2.9, 1.3, 2e-5, 2e-5
RIM = Rim(element_at(VERTEX, pi - PHI) - 2, VERTEX)
NODES = 11
#: displacement in the disk's axes, (constant, linear, squared) in theta, at first and what it grows by in a unit of
#: time: parabolas, which quadratic elements have to the last bit
FIRST = np.array([[1e-5, 2e-3, 0.05], [0.0, 1e-3, -0.02]])
RATES = np.array([[-2e-4, 0.3, 2.0], [0.05, 1.5, -3.0]])


def pose(t):
    return np.array([0.02 * t, -DEPTH - 2e-4 * t, PHI + OMEGA * t])


def displacement(theta, t):
    """Of material points along the floor and upward, (2, n)."""
    away = theta - (pi - PHI)
    u = np.einsum("ij,jn->in", FIRST, [np.ones_like(away), away, away**2])
    u = u + t * np.einsum("ij,jn->in", RATES, [np.ones_like(away), away, away**2])
    s, c = np.sin(PHI + OMEGA * t), np.cos(PHI + OMEGA * t)
    return np.array([u[0] * s + u[1] * c, u[0] * c - u[1] * s])


def abscissa(theta, t):
    psi = PHI + OMEGA * t + theta - pi
    return 0.02 * t + PHI + OMEGA * t - np.sin(psi) + displacement(theta, t)[0]


def gap(theta, t):
    psi = PHI + OMEGA * t + theta - pi
    return -DEPTH - 2e-4 * t + 2 * np.sin(psi / 2) ** 2 + displacement(theta, t)[1]


def step(t, damper):
    middles = (VERTEX + np.append(VERTEX[1:], VERTEX[0] + 2 * pi)) / 2
    nodes = np.column_stack([VERTEX, middles]).ravel()[2 * RIM.first :][:NODES]
    away = nodes - (pi - PHI)
    powers = np.array([np.ones_like(away), away, away**2])
    first, last = (np.ascontiguousarray((shape @ powers).T) for shape in (FIRST, FIRST + RATES * t))
    before = Before(pose(0), first, no_bristles(), RIM.first, first, 0.5)
    law = parameters("patch", SPACING, EPS, 0.8 * EPS)
    return contact_forces(pose(t), last, RIM, law, STICK, before, damper, False)


def velocity(t):
    """Of the rim along the floor at the end of a step, weighed by the pressure."""
    psi = np.linspace(-0.02, 0.02, 100_001)
    theta = psi - (PHI + OMEGA * t) + pi
    by = 1e-6
    rates = (abscissa(theta, t + by) - abscissa(theta, t - by)) / (2 * by)
    return np.average(rates, weights=np.maximum(-gap(theta, t), 0))


def entered(theta, t):
    """When points that are on the floor at ``t`` came to it, 0 of those that were there before."""
    low, high = np.zeros_like(theta), np.full_like(theta, t)
    for _ in range(60):
        middle = (low + high) / 2
        off = gap(theta, middle) > 0
        low, high = np.where(off, middle, low), np.where(off, high, middle)
    return np.where(gap(theta, 0.0) > 0, high, 0.0)


@pytest.mark.parametrize("ratio", [1 / 0.4358665, 4.0])  # of the last stages of ESDIRK3 and of ESDIRK4
def test_bristles_of_points_that_enter_are_stretched_from_where_they_did(ratio):
    """But for the square of the step. A parabola in time of each point's own way, whose velocity at the end is what
    the patch as a whole lets one foresee, would leave an error like the step wherever the dent changes."""
    steps = np.array([4e-3, 2e-3, 1e-3])
    errors = []
    for t in steps:
        way = step(t, UNDAMPED).res.way
        way_0, turning_0 = way - t * velocity(t) / ratio, OMEGA * t * (1 - ratio)
        found = step(t, UNDAMPED._replace(ratio=ratio, way_0=way_0, turning_0=turning_0))
        theta = found.bristles.number * SPACING
        theta, stretch = theta[gap(theta, t) < 0], found.bristles.stretch[gap(theta, t) < 0]
        came = entered(theta, t)
        assert np.count_nonzero(came > 0) > 20
        errors.append(np.abs(stretch - (abscissa(theta, t) - abscissa(theta, came)))[came > 0].max())
    assert errors[0] < 0.1 * np.abs(abscissa(theta, steps[0]) - abscissa(theta, 0.0)).max()
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > 1.7
