"""What the mesh around the ring leaves of a pulse, by which ``solve.elements`` is chosen."""

import numpy as np
import pytest

import flexible
from flexible.ring.fem import AROUND, MESH_ERROR, MESH_SOFT, elements_around, ring_of
from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene, Solve


def normal_impulse(elements, bending_stiffness=65.0):
    """J_N of an undeformed, undamped ring that rolls onto the floor at the weld."""
    scene = Scene(
        Hoop(k=0.1, r=1.02, mass_ratio=0.1), Friction(0.35, 0.3), Release(2.9, 4.0), Run(t_end=0.14),
        ring=Ring(bending_stiffness=bending_stiffness), contact=Contact(law="brush", stiffness=1e7, damping=0.0),
        solve=Solve(resolve="all", start="undeformed", rtol=1e-4, elements=elements, level="reduced"),
    )  # fmt: skip
    return flexible.simulate(scene, history=True).history.normal_impulse[-1]


def test_the_error_of_the_mesh_is_what_elements_are_chosen_by():
    """Richardson: halving the elements changes J_N with an order of 2.2, and by the error that is stated for 240.

    Stress is singular at the weld's corners, so the order is less than the elements' 4; +-0.3 is what steps of 1e-5 of
    J_N make of it.
    """
    found = np.array([normal_impulse(n) for n in (120, 240, 480)])
    changes = np.abs(np.diff(found)) / found[-1]
    order = np.log2(changes[0] / changes[1])
    assert order == pytest.approx(2.2, abs=0.3)
    assert changes[1] / (1 - 2**-order) < 1.3e-4  # of the 240's own error, stated as 1e-4


def test_the_mesh_of_a_stiff_ring_leaves_less():
    """A hundred times as stiff a ring, no less than the root of its stiffness says."""
    found = np.array([normal_impulse(n, 6500.0) for n in (240, 480)])
    assert abs(found[1] / found[0] - 1) < MESH_ERROR * (MESH_SOFT / 6500) ** 0.5
    assert elements_around(1e-6, 1e8) == AROUND
    assert AROUND < elements_around(1e-5, 1e4) < elements_around(1e-5, 1e3)


def test_elements_follow_the_tolerance():
    """Down to 3e-4 the least number, then as many as keep the mesh at a third of rtol by its order."""
    soft = _scene(1e-4).ring.bending_stiffness
    assert [elements_around(rtol, soft) for rtol in (1e-1, 1e-3, 3.001e-4)] == [AROUND] * 3
    more = np.array([elements_around(rtol, soft) for rtol in (1e-4, 1e-5)])
    assert more / AROUND == pytest.approx(np.array([3, 30]) ** (1 / 2.2), rel=1e-2)
    assert ring_of(_scene(1e-4)).mesh.around == more[0]


def _scene(rtol):
    return Scene(
        Hoop(k=0.1, r=1.02),
        Friction(0.35, 0.3),
        Release(1.0),
        ring=Ring(bending_stiffness=65.0),
        solve=Solve(rtol=rtol),
    )
