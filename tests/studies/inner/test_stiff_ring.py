"""By how much a ring gives way at the floor, and from where on by less than the patch."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from flexible.models.select import ring_for
from flexible.ring.fem import membrane_stiffness
from meshes import Placement
from rigid import load_scene
from studies import Ladder
from studies.inner.events import START, passage
from studies.inner.layers import half_width, outer_forces
from studies.inner.scales import epsilon
from studies.inner.separate import compliance, stiff_from

MASSLESS = load_scene("paper-3.3-massless")


def test_a_ring_pressed_opposite_the_weld_gives_way_as_one_between_two_forces() -> None:
    """A thin ring under two opposite forces P is (pi/4 - 2/pi) P R^3/(E I) shorter; R is that of the centre line."""
    thin = MASSLESS.replace(hoop={"r": 1.0005}, ring={"weld_half_angle_deg": 1e-3})
    found = compliance(thin, 0.0)
    assert found[1, 1] == pytest.approx((pi / 4 - 2 / pi), rel=2e-3)  # 1.5 walls, for R^3
    assert found[0, 1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("r", [1.01, 1.02, 1.05])
@pytest.mark.parametrize("phi", [2.0, 1.0, 0.1, 4.5])
def test_a_thin_wall_gives_way_as_its_quads_do(r: float, phi: float) -> None:
    """But for shear, stretch and what the weld's end gives way by, each of the order of the wall."""
    scene = MASSLESS.replace(hoop={"r": r}, ring={"bending_stiffness": 1e4}, solve={"level": "reduced"})
    ring = ring_for(scene)
    rim = ring.mesh.theta[ring.mesh.rim_nodes]
    at = int(np.argmin(np.abs(np.angle(np.exp(1j * (rim - (pi - phi)))))))
    columns, phi = np.array([2 * at, 2 * at + 1]), pi - float(rim[at])
    axes = Placement(phi, 0.0, 0.0).axes
    expected = axes.T @ (ring.pressed(columns)[columns] * 1e4 / membrane_stiffness(scene)) @ axes
    assert np.abs(compliance(scene, phi) - expected).max() < 2 * scene.wall * np.abs(expected).max()


def test_a_mirrored_ring_gives_way_to_the_other_side_and_over_the_weld_not_at_all() -> None:
    there, here = compliance(MASSLESS, 2.5), compliance(MASSLESS, -2.5)
    np.testing.assert_allclose(here * [[1, -1], [-1, 1]], there, rtol=1e-9, atol=0)
    assert not compliance(MASSLESS, pi + 0.03).any()


@pytest.mark.parametrize("mass_ratio", [0.0, 1e-3])
def test_ring_and_patch_give_way_alike_where_it_is_said(mass_ratio: float) -> None:
    """The patch by 1/(2 eps_n a), as dN/ddelta of a parabolic rim is; behind the stops and reversals of the pulse."""
    scene = load_scene("paper-3.2-k0.25").replace(hoop={"mass_ratio": mass_ratio})
    way = passage(scene)
    rung = Ladder.around(scene).rungs(scene)[0]
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
