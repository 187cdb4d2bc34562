"""A rigid rim pressed on the floor and moved as told, for tests of the contact alone."""

from math import pi

import numpy as np

from flexible.contact.forces import contact_forces
from flexible.contact.laws.listing import LAWS
from flexible.contact.points.data import UNDAMPED, Before, Parameters, Rim, no_bristles
from flexible.contact.points.rim import element_at

VERTEX = -pi + 2 * pi / 240 * np.arange(240)


def parameters(law, spacing, eps_n, eps_t, mu_s=0.3, mu=0.3, slip_scale=1e-3):
    """Parameters of the contact under the law of this name."""
    return Parameters(LAWS[law].code, spacing, eps_n, eps_t, mu_s, mu, slip_scale, 1e-9)


class Floor:
    """A rim at depth ``depth`` under the floor's surface."""

    def __init__(self, law, depth, phi=2.9, mode=0):
        self.law, self.mode = law, mode
        self.pose = np.array([0.0, -depth, phi])
        self.bristles = no_bristles()
        self.result = self._forces(self.pose)
        self.bristles = self.result.bristles._replace(stretch=np.zeros(len(self.result.bristles.stretch)))

    def _forces(self, pose, damper=UNDAMPED):
        rim = Rim(element_at(VERTEX, pi - pose[2]) - 6, VERTEX)
        flat = np.zeros((2 * 13 + 1, 2))
        before = Before(self.pose, flat, self.bristles)
        return contact_forces(pose, flat, rim, self.law, self.mode, before, damper, True)

    def move(self, dv, dphi, damper=UNDAMPED, rise=0.0):
        """One step; returns the resultants."""
        pose = self.pose + np.array([dv, rise, dphi])
        self.result = self._forces(pose, damper)
        self.bristles = self.result.bristles
        self.pose = np.array([0.0, pose[1], pose[2]])
        return self.result.res
