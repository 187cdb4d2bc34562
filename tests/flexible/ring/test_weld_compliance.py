"""The welded ring against the thin ring clamped at a point, and the reduced ring against the welded one."""

from math import pi

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from flexible.ring.choice import ring_of
from flexible.ring.fem import Ring, membrane_stiffness
from flexible.ring.rim.reduction import reduce
from meshes import ring_mesh
from rigid import Friction, Hoop, Release, Scene, Solve

# C_rr in a^3/(E I) of a thin ring clamped at 0, loaded radially at the angle psi (Castigliano)
RADIAL = {30: 3.68e-2, 45: 0.10267, 90: 0.35032, 120: 0.35252, 180: 0.148778}
TANGENTIAL_180 = 1.08295


def compliances(wall):
    """C_rr at the angles of ``RADIAL`` and C_tt opposite to a short weld, times E I/a^3, of a ring of wall h/a."""
    inner, outer = 1 - wall / 2, 1 + wall / 2
    # 360 elements of a degree: every angle of the table is a node; the weld holds one element
    ring = Ring(ring_mesh(inner, outer, 360, 2, weld_half_angle=pi / 180), 0.3)
    scale = wall**3 / 12
    found = []
    for degrees, along in [*((d, "r") for d in RADIAL), (180, "t")]:
        psi = np.deg2rad(degrees)
        node = int(np.argmax(np.cos(ring.mesh.rim_theta - psi)))
        c, s = np.cos(ring.mesh.rim_theta[node]), np.sin(ring.mesh.rim_theta[node])
        way = np.array([c, s]) if along == "r" else np.array([-s, c])
        load = np.zeros(len(ring.free))
        load[ring.rim_dofs.reshape(-1, 2)[node]] = way
        found.append(load @ ring.solve(load) * scale)
    return np.array(found)


def test_thin_ring_clamped_at_the_weld():
    """The table, within the angle that the weld takes from the ring and the wall: both are lengths of order h.

    The clamped end moves by about the weld's half-angle and by the h that the stress takes to spread: the relative
    error of a cantilever of length psi is 3 times their share of it.
    """
    exact = np.array([*RADIAL.values(), TANGENTIAL_180])
    lengths = np.deg2rad([*RADIAL, 180])
    wall = 0.02
    assert (np.abs(compliances(wall) / exact - 1) < 3 * (wall + pi / 180) / lengths + 1e-3).all()


SCENE = Scene(Hoop(k=0.1, r=1.02, mass_ratio=0.1), Friction(0.35, 0.3), Release(1.0), solve=Solve(elements=240))


def test_rim_compliance_is_symmetric_and_positive():
    """Maxwell's reciprocity and positive work."""
    ring = ring_of(SCENE)
    sample = ring.rim_compliance[::40, ::40]
    assert np.abs(sample - sample.T).max() == 0
    assert np.linalg.eigvalsh(sample).min() > 0


def test_modes_and_residual_add_up_to_the_static_compliance():
    """Craig-Bampton with static correction is exact at rest, whatever the number of modes.

    To it belongs what the contact has point by point, whose answer to the nodes' loads is their shape functions' share
    of it. How far rounding takes both from it is seen where reciprocity fails.
    """
    ring, stiffness = ring_of(SCENE), membrane_stiffness(SCENE)
    own = reduce(SCENE, 1).within * np.kron(np.linalg.inv(ring.rim_products.toarray()), np.eye(2))
    every = ring.pressed(np.arange(len(ring.rim_dofs))) / stiffness
    exact = (every + every.T) / 2 - own
    solved = ring.solve_rim(np.arange(len(exact)))[0] / stiffness
    rounding = np.abs(solved - solved.T).max()
    assert rounding < 1e-8 * np.abs(exact).max()
    for count in (1, 7, 24):
        reduced = reduce(SCENE, count)
        every = np.arange(len(exact))
        held = (reduced.rim_shapes / reduced.frame.modal[:, 0]) @ reduced.rim_shapes.T + reduced.compliance(
            every, every
        )
        assert np.abs(held - exact).max() < rounding


def test_dynamic_compliance_lacks_what_the_left_out_modes_add():
    """At the frequency omega the static correction leaves (omega/omega_n)^2 of what a left-out mode n would add.

    Between the third and the fourth frequency that is 4e-5 and more of the compliance for up to 24 modes: far above
    the round-off of the direct solution, 1e-9. A point of a thin ring receives from a mode of wave number n about
    1/omega_n^2 with omega_n ~ n^2; what is left out adds up as the sum of omega^2/omega_n^4 ~ n^-8 from the last mode
    on, or n^-7. Each wave number from 2 on has two modes: with 12 and 24 of them n goes from 7 to 13. The modes of a
    pair differ at the loaded point, by sin^2 and cos^2 of n psi: within a factor of 2.
    """
    ring, mass = ring_of(SCENE), SCENE.hoop.mass_ratio
    stiffness = membrane_stiffness(SCENE)
    every = reduce(SCENE, 48)
    squares, shapes = every.frame.modal[:, 0], every.rim_shapes[2 * 300]
    square = (squares[3] + squares[4]) / 2
    dof = ring.rim_dofs[2 * 300]
    load = np.zeros(len(ring.free))
    load[dof] = 1.0
    exact = spsolve((ring.free_stiffness * stiffness - square * mass * ring.free_mass).tocsc(), load)[dof]
    here = np.array([2 * 300])
    missing = {}
    for count in (6, 12, 24, 48):
        reduced = reduce(SCENE, count)
        shape = reduced.rim_shapes[2 * 300]
        found = (shape**2 / (reduced.frame.modal[:, 0] - square)).sum() + float(reduced.compliance(here, here)[0, 0])
        missing[count] = exact - found
    for count in (6, 12, 24):
        added = (shapes**2 * (1 / (squares - square) - 1 / squares))[count:].sum()
        assert missing[count] - missing[48] == pytest.approx(added, abs=1e-8 * abs(exact))
    assert 0.5 < missing[12] / missing[24] / (13 / 7) ** 7 < 2
