"""What the mesh around the ring leaves of a pulse, by which ``solve.elements`` is chosen."""

import numpy as np
import pytest

import flexible
from flexible.ring.fem import (
    AROUND,
    MESH_ERROR,
    MESH_ORDER,
    MESH_SOFT,
    MESH_THIN,
    MESH_WALL,
    elements_around,
    elements_through,
    ring_of,
)
from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene, Solve


def impulses(elements, through, bending_stiffness=65.0, r=1.02):
    """J_N, J_F and friction loss of an undeformed, undamped ring that rolls onto the floor at the weld."""
    scene = Scene(
        Hoop(k=0.1, r=r, mass_ratio=0.1), Friction(0.35, 0.3), Release(2.9, 4.0), Run(t_end=0.14),
        ring=Ring(bending_stiffness=bending_stiffness), contact=Contact(law="brush", stiffness=1e7, damping=0.0),
        solve=Solve(
            resolve="all", start="undeformed", rtol=1e-5, elements=elements, through=through, level="reduced"
        ),
    )  # fmt: skip
    last = flexible.simulate(scene, history=True).history
    return np.array([last.normal_impulse[-1], last.friction_impulse[-1], last.friction_loss[-1]])


def error(found, true):
    """The largest, over J_N."""
    return np.abs(found - true).max() / true[0]


def test_the_error_of_the_mesh_is_what_elements_are_chosen_by():
    """Against 720 elements: the error that is stated for 240 of a wall of 2 %, and the order with which it falls.

    The steps' own, of 1e-5, is a fourteenth of what 120 elements leave and a half of what 360 do.
    """
    found = [impulses(n, 2) for n in (120, 240, 360, 720)]
    errors = np.array([error(one, found[-1]) for one in found[:-1]])
    assert errors[1] == pytest.approx(MESH_ERROR, rel=0.35)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(MESH_ORDER, abs=0.5)
    assert errors[2] < errors[1] / 2


@pytest.mark.parametrize("r", [1.002, 1.005, 1.01])
def test_long_quads_leave_more(r):
    """Of walls 13 to 3 times as thin as the quads are long what the power of the wall says, or down to half of it."""
    stated = MESH_ERROR * (MESH_WALL / (1 - 1 / r)) ** MESH_THIN
    assert 0.5 * stated < error(impulses(240, 1, r=r), impulses(720, 1, r=r)) < 1.2 * stated


def test_the_mesh_of_a_stiff_ring_leaves_less():
    """A hundred times as stiff a ring, no more than the root of its stiffness says."""
    assert error(impulses(240, 2, 6500.0), impulses(480, 2, 6500.0)) < MESH_ERROR * (MESH_SOFT / 6500) ** 0.5
    assert elements_around(1e-6, 1e8, 0.02) == AROUND
    assert AROUND < elements_around(1e-6, 1e4, 0.02) < elements_around(1e-6, 1e3, 0.02)


def test_elements_follow_the_tolerance():
    """Around, down to 1e-4 the least number, then as many as keep the mesh at a third of rtol by its order.

    Through the wall, the least number down to 1e-4, then by their order, 4: of the ring's compliance ten times rtol.
    """
    scene, wall = _scene(1e-4), 1 - 1 / 1.02
    soft = scene.ring.bending_stiffness
    assert [elements_around(rtol, soft, wall) for rtol in (1e-1, 1e-3, 1e-4)] == [AROUND] * 3
    more = np.array([elements_around(rtol, soft, wall) for rtol in (1e-5, 1e-6)])
    stated = MESH_ERROR * (MESH_WALL / wall) ** MESH_THIN
    assert more / AROUND == pytest.approx((3 * stated / np.array([1e-5, 1e-6])) ** (1 / MESH_ORDER), rel=1e-2)
    assert ring_of(_scene(1e-5)).mesh.around == more[0]
    assert [elements_through(0.2, rtol) for rtol in (1e-2, 1e-4, 1e-5, 1e-9)] == [3, 3, 5, 6]
    assert len(ring_of(_scene(1e-5)).mesh.grid) == 2 * elements_through(wall, 1e-5) + 1 == 5


def _scene(rtol):
    return Scene(
        Hoop(k=0.1, r=1.02),
        Friction(0.35, 0.3),
        Release(1.0),
        ring=Ring(bending_stiffness=65.0),
        solve=Solve(rtol=rtol),
    )
