"""A rim that tilts and bends over its patch as it is pressed more, and moves evenly: all of it known in time."""

from math import pi

import numpy as np
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


def powers(theta):
    away = theta - (pi - PHI)
    return np.array([np.ones_like(away), away, away**2])


def displacement(theta, t):
    """Of material points, in the disk's axes, (2, n); at one instant, or each point at its own."""
    return FIRST @ powers(theta) + t * (RATES @ powers(theta))


def step(t, damper=UNDAMPED):
    """The contact at the end of a step of length t from t = 0, of a patch without bristles."""
    middles = (VERTEX + np.append(VERTEX[1:], VERTEX[0] + 2 * pi)) / 2
    nodes = np.column_stack([VERTEX, middles]).ravel()[2 * RIM.first :][:NODES]
    # laid out as a ring has them: for others the contact would be compiled anew
    first, last = (np.ascontiguousarray(displacement(nodes, at).T) for at in (0, t))
    law = parameters("patch", SPACING, EPS, 0.8 * EPS)
    before = Before(pose(0), first, no_bristles(), RIM.first, first, 0.5)
    return contact_forces(pose(t), last, RIM, law, STICK, before, damper, False)


def place(theta, t):
    """Abscissa and gap of material points, likewise."""
    x, height, phi = pose(t)
    psi, u = phi + theta - pi, displacement(theta, t)
    s, c = np.sin(phi), np.cos(phi)
    return x + phi - np.sin(psi) + u[0] * s + u[1] * c, height + 2 * np.sin(psi / 2) ** 2 + u[0] * c - u[1] * s


def mean_velocity(t):
    """Velocity of the rim along the floor, weighed by the pressure, by quadrature."""
    phi = pose(t)[2]
    s, c = np.sin(phi), np.cos(phi)
    psi = np.linspace(-0.02, 0.02, 400_001)
    theta = psi - phi + pi
    u, rate = displacement(theta, t), RATES @ powers(theta)
    pressure = np.maximum(-place(theta, t)[1], 0)
    assert pressure[0] == pressure[-1] == 0
    turning = OMEGA * (1 - np.cos(psi) + u[0] * c - u[1] * s)
    return np.average(0.02 + turning + rate[0] * s + rate[1] * c, weights=pressure)
