"""By how much a ring gives way at the floor, and from where on by less than the patch."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

from rigid import load_scene
from studies import Ladder
from studies.inner.events import START, passage
from studies.inner.layers import half_width, outer_forces
from studies.inner.scales import epsilon
from studies.inner.separate import compliance, stiff_from

MASSLESS = load_scene("paper-3.3-massless")


def bending(scene, phi: float):
    """The compliance of a wall that does nothing but bend, by Castigliano: two arms of its centre line, clamped at the
    ends of the weld and joined at the floor."""
    held, radius, theta = scene.ring.weld_half_angle, 1 - scene.wall / 2, (pi - phi) % (2 * pi)
    points, weights = np.polynomial.legendre.leggauss(40)
    stiffness = np.zeros((3, 3))
    for end in (held, 2 * pi - held):
        at = (theta + end) / 2 + (theta - end) / 2 * points
        # about the sections, under a force along y1, one along y2 and a moment on the rim at the floor
        moments = np.array([radius * np.sin(at) - sin(theta), cos(theta) - radius * np.cos(at), np.ones_like(at)])
        stiffness += np.linalg.inv(moments * (weights * radius * abs(theta - end) / 2) @ moments.T)
    axes = np.array([[sin(phi), cos(phi)], [cos(phi), -sin(phi)]])
    return axes.T @ np.linalg.inv(stiffness)[:2, :2] @ axes


def test_a_ring_pressed_opposite_a_narrow_weld_is_one_between_two_forces() -> None:
    """A thin ring under two opposite forces P is (pi/4 - 2/pi) P R^3/(E I) shorter; R is that of the centre line."""
    thin = MASSLESS.replace(hoop={"r": 1.0005}, ring={"weld_half_angle_deg": 1e-3})
    assert bending(thin, 0.0)[1, 1] == pytest.approx((pi / 4 - 2 / pi), rel=2e-3)  # 1.5 walls, for R^3


@pytest.mark.parametrize("r", [1.01, 1.02, 1.05])
@pytest.mark.parametrize("phi", [2.0, 1.0, 0.1, 4.5])
def test_a_thin_wall_gives_way_as_one_that_bends(r: float, phi: float) -> None:
    """But for shear, stretch and what the weld's end gives way by, each of the order of the wall; at a node, of 480,
    that is up to half of their distance from the angle, of which a compliance changes by three times as much."""
    scene = MASSLESS.replace(hoop={"r": r})
    phi = pi - 2 * pi / 480 * round((pi - phi) * 480 / (2 * pi))
    expected = bending(scene, phi)
    off = np.abs(compliance(scene, phi) - expected).max() / np.abs(expected).max()
    assert off < 2 * scene.wall + 3 * pi / 480


def test_a_thick_wall_gives_way_beside_its_weld_by_far_more_than_it_bends() -> None:
    thick = MASSLESS.replace(hoop={"r": 1.25})
    assert compliance(thick, pi - 0.2)[1, 1] > 10 * bending(thick, pi - 0.2)[1, 1]


def test_a_mirrored_ring_gives_way_to_the_other_side() -> None:
    there, here = compliance(MASSLESS, 2.5), compliance(MASSLESS, -2.5)
    np.testing.assert_allclose(here * [[1, -1], [-1, 1]], there, rtol=1e-6, atol=0)


@pytest.mark.parametrize("mass_ratio", [0.0, 1e-3])
def test_ring_and_patch_give_way_alike_where_it_is_said(mass_ratio: float) -> None:
    """The patch by 1/(2 eps_n a), as dN/ddelta of a parabolic rim is; behind the stops and reversals of the pulse."""
    scene = load_scene("paper-3.2-k0.25").replace(hoop={"mass_ratio": mass_ratio})
    way = passage(scene)
    rung = Ladder().rungs(scene)[0]
    foundation = stiff_from(way, rung)
    stiff = rung.replace(contact={"stiffness": foundation})
    bending = rung.ring.bending_stiffness * foundation / rung.contact.stiffness
    over = []
    for event in (each for each in way.events if each.kind != START):
        half = half_width(outer_forces(way.body, event, True)[0]) * epsilon(stiff)
        by = compliance(scene, event.phi)
        ring = (by[1, 1] + (event.behind or 0.0) * by[1, 0]) / bending
        over.append(ring * 2 * foundation * half)
    assert max(over) == pytest.approx(1.0, rel=1e-9)
    assert stiff_from(replace(way, events=()), rung) == 0.0
