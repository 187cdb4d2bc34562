"""The slip velocity of a patch: the rate of its way in a step, and what its points have, weighed by their pressure."""

from math import cos, pi, sin

import numpy as np
from kinematic import VERTEX, parameters

from flexible.contact.forces import contact_forces
from flexible.contact.laws.patch import STICK
from flexible.contact.points.data import UNDAMPED, Before, Rim, no_bristles
from flexible.contact.points.rim import element_at

EPS, PHI, OMEGA, DEPTH = 1e6, 2.9, 1.3, 2e-5
RIM = Rim(element_at(VERTEX, pi - PHI) - 2, VERTEX)
NODES = 11
#: displacement in the disk's axes, (constant, linear, squared) in theta, at first and what it grows by: a wall that
#: tilts and bends over the patch as it is pressed more, of parabolas that quadratic elements have to the last bit
FIRST = np.array([[1e-5, 2e-3, 0.05], [0.0, 1e-3, -0.02]])
RATES = np.array([[-2e-4, 0.3, 2.0], [0.05, 1.5, -3.0]])


def pose(t):
    return np.array([0.02 * t, -DEPTH - 2e-4 * t, PHI + OMEGA * t])


def powers(theta):
    away = theta - (pi - PHI)
    return np.array([np.ones_like(away), away, away**2])


def step(t):
    """The contact at the end of a step of length t from t = 0."""
    middles = (VERTEX + np.append(VERTEX[1:], VERTEX[0] + 2 * pi)) / 2
    nodes = np.column_stack([VERTEX, middles]).ravel()[2 * RIM.first :][:NODES]
    # laid out as a ring has them: for others the contact would be compiled anew
    first, last = (np.ascontiguousarray((shape @ powers(nodes)).T) for shape in (FIRST, FIRST + RATES * t))
    law = parameters("patch", 2e-5, EPS, 0.8 * EPS)
    before = Before(pose(0), first, no_bristles(), RIM.first, first, 0.5)
    return contact_forces(pose(t), last, RIM, law, STICK, before, UNDAMPED, False).res


def mean_velocity(t):
    """Velocity of the rim along the floor, weighed by the pressure, by quadrature."""
    _, height, phi = pose(t)
    s, c = sin(phi), cos(phi)
    psi = np.linspace(-0.02, 0.02, 400_001)
    theta = psi - phi + pi
    u, rate = (FIRST + RATES * t) @ powers(theta), RATES @ powers(theta)
    pressure = np.maximum(-(height + 2 * np.sin(psi / 2) ** 2 + u[0] * c - u[1] * s), 0)
    assert pressure[0] == pressure[-1] == 0
    turning = OMEGA * (1 - np.cos(psi) + u[0] * c - u[1] * s)
    return np.average(0.02 + turning + rate[0] * s + rate[1] * c, weights=pressure)


def test_the_slip_velocity_is_the_mean_of_the_points():
    """The rate of the way at the end of a step is their mean but for the step's square.

    A way along the dent as it was alone, and weights of the end of the step alone, leave an error like the step. Of a
    rate that points 2e-5 apart know to 1e-6 of it.
    """
    steps = np.array([4e-3, 2e-3, 1e-3])
    errors = []
    for t in steps:
        by = 1e-3 * t
        rate = (step(t + by).way - step(t - by).way) / (2 * by)
        errors.append(abs(rate - mean_velocity(t)))
    assert errors[0] < 1e-2 * abs(mean_velocity(steps[0]))
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > 1.7
