"""A rigid rim pressed on the floor and moved as told, for tests of the contact alone."""

from math import pi

import numpy as np

from flexible.contact.detection import element_at
from flexible.contact.forces import BRUSH, UNDAMPED, contact_forces

VERTEX = -pi + 2 * pi / 240 * np.arange(240)


class Rim:
    """A rim at depth ``depth`` under the floor's surface; ``law`` is (spacing, eps_n, eps_t, mu_s, mu)."""

    def __init__(self, law, depth, phi=2.9, mode=BRUSH):
        self.law, self.mode = np.array(law, dtype=float), mode
        self.pose = np.array([0.0, -depth, phi])
        self.bristles, self.flags = np.empty((0, 3)), np.empty(0, np.int8)
        self.result = self._forces(self.pose)
        self.bristles, self.flags = self.result[4].copy(), self.result[5].copy()
        self.bristles[:, 1] = 0.0

    def _forces(self, pose):
        first = element_at(VERTEX, pi - pose[2]) - 6
        flat = np.zeros((2 * 13 + 1, 2))
        return contact_forces(
            pose, flat, first, VERTEX, self.law, self.mode, self.pose, flat, self.bristles, self.flags, UNDAMPED
        )

    def move(self, dv, dphi):
        """One step; returns the resultants."""
        pose = self.pose + np.array([dv, 0.0, dphi])
        self.result = self._forces(pose)
        self.bristles, self.flags = self.result[4], self.result[5]
        self.pose = np.array([0.0, pose[1], pose[2]])
        return self.result[3]
