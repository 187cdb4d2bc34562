"""Frames without a solver: a ring that ovalises (n = 2) while it rolls over the floor."""

from math import pi
from types import SimpleNamespace

import numpy as np
import pytest

from meshes import Frame, disk_block, floor_block, rim_block, ring_block, ring_mesh

K, R0 = 0.25, 1 / 1.02


def oval_frames(ring, times, amplitude=1e-3):
    """Frames at ``times``: radial displacement ``amplitude`` cos 2 theta, the disk at phi = 2.2 + t."""
    floor = floor_block(-2.0, 4.0, 0.1)
    cos, sin = np.cos(ring.theta), np.sin(ring.theta)
    for time in times:
        phi = 2.2 + time
        # y1 points to the disk, (sin phi, cos phi) in the world; y2 is 90 degrees clockwise from it
        axes = np.array([[np.sin(phi), np.cos(phi)], [np.cos(phi), -np.sin(phi)]])
        centre = np.array([time, 1.0])
        points = centre + ring.points @ axes
        wave = amplitude * np.cos(time)
        radial, hoop = wave * np.cos(2 * ring.theta), -wave / 2 * np.sin(2 * ring.theta)
        u = np.column_stack([radial * cos - hoop * sin, radial * sin + hoop * cos]) @ axes
        stress = np.column_stack([radial, hoop, radial * hoop])
        rim = ring.rim_nodes
        pressure = np.exp(-(((ring.rim_theta + phi) % (2 * pi) - pi) ** 2) / 0.02)
        yield Frame(
            time,
            {
                "ring": ring_block(
                    ring,
                    points,
                    displacement=u,
                    velocity=-np.tan(time) * u,
                    stress=stress,
                    von_mises=np.abs(radial),
                    hoop_stress=hoop,
                    bending_stress=radial - hoop,
                    energy_density=radial**2,
                ),
                "rim": rim_block(
                    ring,
                    points[rim],
                    displacement=u[rim],
                    pressure=pressure,
                    traction=0.3 * pressure,
                    stick=(pressure > 0.5).astype(np.uint8),
                ),
                "disk": disk_block(centre + (1 - K) * R0 * axes[0], K * R0, phi),
                "floor": floor,
            },
        )


def oval_history(times):
    """Forces and phases to go with :func:`oval_frames`."""
    t = np.linspace(times[0], times[-1], 200)
    third = (times[-1] - times[0]) / 3
    starts = times[0] + third * np.arange(3)
    return {
        "t": t,
        "normal_force": 1 + np.cos(t) ** 2,
        "friction_force": 0.3 * np.sin(2 * t),
        "phase_kind": np.array(["roll", "spin", "flight"]),
        "phase_start": starts,
        "phase_end": starts + third,
    }


@pytest.fixture(scope="session")
def ring():
    return ring_mesh(R0, 1.0, 240, 1)


@pytest.fixture(scope="session")
def ovals():
    """The functions above as a fixture: test modules of other folders have a conftest too."""
    return SimpleNamespace(frames=oval_frames, history=oval_history)
