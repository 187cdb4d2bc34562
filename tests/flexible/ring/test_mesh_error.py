"""What the mesh around the ring leaves of a pulse, by which ``solve.elements`` is chosen."""

import numpy as np
import pytest

import flexible
from flexible.ring.choice import (
    AROUND,
    DENT_ERROR,
    FAR_ERROR,
    FAR_SOFT,
    FAR_SOFTER,
    MESH_ERROR,
    MESH_ORDER,
    MESH_SOFT,
    MESH_THIN,
    MESH_WALL,
    MOST_DENT,
    MOST_FAR,
    MOST_THROUGH,
    elements_around,
    elements_bent_far,
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


@pytest.mark.slow
def test_the_error_of_the_mesh_is_what_elements_are_chosen_by():
    """Against 720 elements: the error that is stated for 240 of a wall of 2 %, and the order with which it falls.

    The steps' own, of 1e-5, is a fourteenth of what 120 elements leave and a half of what 360 do.
    """
    found = [impulses(n, 2) for n in (120, 240, 360, 720)]
    errors = np.array([error(one, found[-1]) for one in found[:-1]])
    assert errors[1] == pytest.approx(MESH_ERROR, rel=0.35)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(MESH_ORDER, abs=0.5)
    assert errors[2] < errors[1] / 2


@pytest.mark.parametrize("r", [1.002, pytest.param(1.005, marks=pytest.mark.slow), 1.01])
def test_long_quads_leave_more(r):
    """Of walls 13 to 3 times as thin as the quads are long what the power of the wall says, or down to half of it."""
    stated = MESH_ERROR * (MESH_WALL / (1 - 1 / r)) ** MESH_THIN
    assert 0.5 * stated < error(impulses(240, 1, r=r), impulses(720, 1, r=r)) < 1.2 * stated


@pytest.mark.slow
def test_a_thick_soft_wall_leaves_what_it_is_dented_by():
    """Against twice as many both ways: what is stated, or down to half of it, and with as many more around a tenth."""
    wall = 1 - 1 / 1.1
    stated = min(DENT_ERROR * wall**3 / (12 * 65), MOST_DENT)
    coarse, around, fine = (impulses(n, t, r=1.1) for n, t in ((240, 2), (480, 2), (480, 4)))
    assert 0.5 * stated < error(coarse, fine) < stated
    assert error(around, fine) < stated / 10
    assert elements_around(1e-4, 65.0, wall) == pytest.approx(AROUND * (3 * stated / 1e-4) ** (1 / MESH_ORDER), abs=1)


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
    assert [elements_through(1 / 6, rtol) for rtol in (1e-2, 1e-4, 1e-5, 1e-9)] == [3, 3, 5, MOST_THROUGH]
    # a wall twice as thick has four times the error, and a pulse knows 32 times as much of it; they are whole numbers
    assert elements_through(1 / 3, 1e-4) / elements_through(1 / 6, 1e-4) == pytest.approx((4 * 32) ** 0.25, rel=0.2)
    assert len(ring_of(_scene(1e-5)).mesh.grid) == 2 * elements_through(wall, 1e-5) + 1 == 5


@pytest.mark.parametrize("r", [1.02, 1.05, 1.2, 1.5])
def test_the_outermost_quads_of_a_thick_wall_are_half_as_thick_as_they_are_long(r):
    """To within the root of two that halves leave; a thin one, which bends under the waves of the nodes, stays even."""
    for linear in (True, False):
        ring = ring_of(_scene(1e-3).replace(hoop={"r": r}), linear=linear).mesh
        thickness = np.diff(ring.radius[ring.grid[::2, 0]])
        through = elements_through(1 - 1 / r, *[1e-3] * linear)
        assert thickness.max() / thickness.min() == pytest.approx(2 ** (len(thickness) - through))
        if r == 1.02:
            assert np.ptp(thickness) < 1e-14
        else:
            assert 2**-0.5 < 2 * thickness[-1] / (2 * np.pi / ring.around) < 2**0.5


def _scene(rtol):
    return Scene(
        Hoop(k=0.1, r=1.02),
        Friction(0.35, 0.3),
        Release(1.0),
        ring=Ring(bending_stiffness=65.0),
        solve=Solve(rtol=rtol),
    )


def soft_pulse(bending_stiffness, **solve):
    """First pulse of an undamped hoop whose wall lies on the floor beside the weld."""
    scene = Scene(
        Hoop(k=0.1, r=1.02, mass_ratio=0.05), Friction(0.35, 0.3), Release(phi0_deg=10), Run(until="pulse"),
        ring=Ring(bending_stiffness=bending_stiffness), contact=Contact(stiffness=1e8, damping=0.0),
        solve=Solve(level="chain", **solve),
    )  # fmt: skip
    return flexible.simulate(scene).pulses[0]


@pytest.mark.slow
@pytest.mark.parametrize("bending_stiffness", [10.0, 5.0, 1.0])
def test_the_error_of_a_mesh_that_bends_far_is_no_more_than_elements_are_chosen_by(bending_stiffness):
    """Impulses and loss over J_N with 240 elements, against as many as are chosen at most; a step's error beside it."""
    coarse, fine = (soft_pulse(bending_stiffness, rtol=1e-4, elements=n) for n in (AROUND, MOST_FAR))
    found = np.array([(p.normal_impulse, p.friction_impulse, p.friction_loss) for p in (coarse, fine)])
    stated = FAR_ERROR * (FAR_SOFT / bending_stiffness) ** FAR_SOFTER
    assert error(found[0], found[1]) < stated + 1e-4


@pytest.mark.slow
def test_tolerance_alone_tells_which_way_a_pulse_goes_on():
    """At E I = 3 the hoop comes down beside the weld on a patch shorter than one of 240 elements, and goes on in one of
    two ways, whose largest forces are a sixth apart: rough tolerances have to find the way of the finer ones.

    J_F, whose two ways all but cancel, is told by J_N.
    """
    rough, finer = (soft_pulse(3.0, rtol=rtol) for rtol in (1e-3, 1e-4))
    assert rough.peak_normal_force == pytest.approx(finer.peak_normal_force, rel=0.01)
    assert rough.normal_impulse == pytest.approx(finer.normal_impulse, rel=1e-3)
    assert rough.friction_impulse == pytest.approx(finer.friction_impulse, abs=1e-3 * finer.normal_impulse)
    assert rough.friction_loss == pytest.approx(finer.friction_loss, rel=0.02)


def test_elements_of_a_ring_that_bends_far_follow_tolerance_and_stiffness():
    """So many that a third of rtol is left, of an error of the first order: between 240 and twice as many."""
    assert [elements_bent_far(1e-3, soft) for soft in (39.0, FAR_SOFT, 3.0, 0.5)] == [AROUND, AROUND, *[MOST_FAR] * 2]
    for rtol, soft in ((1e-3, 3.0), (1e-4, 12.9)):  # as `Solve` says, to the digits that it says
        assert elements_bent_far(rtol, soft) == MOST_FAR > elements_bent_far(rtol, 1.03 * soft)
    between = elements_bent_far(2e-4, FAR_SOFT)
    assert between == pytest.approx(AROUND * 3 * FAR_ERROR / 2e-4, abs=1)
    assert between % 2 == 0, "a part has two"
    assert elements_bent_far(2e-4, 2 * FAR_SOFT) == AROUND
    assert elements_bent_far(1e-4, 1.5 * FAR_SOFT) == pytest.approx(AROUND * 3 / 1.5**FAR_SOFTER, abs=1)
    assert elements_bent_far(1e-7, FAR_SOFT) == MOST_FAR
    soft = {"ring": {"bending_stiffness": 5.0}}
    assert ring_of(_scene(1e-4).replace(**soft), linear=False).mesh.around == MOST_FAR
    gentle = _scene(1e-4).replace(**soft, contact={"stiffness": 1e5})  # no floor that feels the places on an element
    assert ring_of(gentle).mesh.around == AROUND, "a linear ring has no wall that lies down"
