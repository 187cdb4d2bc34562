"""A rim that is the same at all places of an element, for floors far stiffer than the wall."""

import numpy as np
import pytest

import flexible
import rigid
from flexible.ring.choice import elements_of_stout, feels_places, ring_of
from flexible.ring.rim.curve import curve, finer
from flexible.ring.rim.even import EvenRim, parts_of
from rigid import Run

PULSE = rigid.load_scene("paper-3.3-massless").replace(run=Run(until="pulse"))


def on_stiff_floor(r=1.02, bending=1e3, foundation=1e12, damping=1.0, **solve):
    return PULSE.replace(
        hoop={"r": r}, ring={"bending_stiffness": bending},
        contact={"stiffness": foundation, "damping": damping}, solve=solve,
    )  # fmt: skip


@pytest.fixture(scope="module", params=[1.02, 1.1])
def ring(request):
    return ring_of(on_stiff_floor(request.param, rtol=1e-3))


def outward(rim, theta):
    """Displacement outward of some nodes of an even rim under a force there, one after the other."""
    nodes = [int(np.argmin(np.abs(rim.theta - angle))) for angle in theta]
    dofs = (2 * np.array(nodes)[:, None] + np.arange(2)).ravel()
    block = rim.solve_rim(dofs)[0]
    found = []
    for node in nodes:
        way = np.array([np.cos(rim.theta[node]), np.sin(rim.theta[node])])
        found.append(way @ block[2 * node : 2 * node + 2, 2 * node : 2 * node + 2] @ way)
    return np.array(found)


def wave(values, order=5):
    """Largest less smallest of what a polynomial over the places leaves."""
    x = np.linspace(-1, 1, len(values))
    return float(np.ptp(values - np.polynomial.Legendre.fit(x, values, order)(x)))


def test_the_curve_has_the_nodes_and_every_parabola_and_no_kinks(ring):
    theta = ring.mesh.rim_theta
    fine = finer(theta, 8)
    through = curve(theta, 8)
    values = np.sin(3 * theta) + np.cos(7 * theta)
    assert (through @ values)[::8] == pytest.approx(values, abs=1e-14)
    inside = slice(80, -80)  # no parabola goes round
    assert (through @ theta**2)[inside] == pytest.approx(fine[inside] ** 2, abs=1e-12)

    def kinks(parts):
        """Of slopes on either side of vertices, of values at random."""
        moved = curve(theta, parts) @ np.random.default_rng(1).standard_normal(len(theta))
        step = np.diff(moved) * parts
        at = 2 * parts * np.arange(1, len(theta) // 2 - 1)
        return np.abs(step[at] - step[at - 1]).max()

    assert kinks(64) < 0.6 * kinks(32) < 0.36 * kinks(16), "of a smooth line they fall like the distance"


def test_a_force_stands_as_deep_on_one_place_as_on_another(ring):
    """Quads give way by 0.7/(E b) more or less; here next to none of that is left, on the weld's arc and beside it.

    What is smooth over the places, a polynomial over six elements, is the ring's own.
    """
    rim, length = EvenRim(ring), 2 * np.pi / ring.mesh.around
    half, weld = length * np.arange(-3, 3, 1 / (2 * rim.parts)), ring.mesh.weld_half_angle
    beside = outward(rim, 0.6 + half)
    assert wave(beside) < 0.05 + 5e-6 * beside.max()  # of a thin ring's bend that much is known between nodes
    plain = ring.rim_compliance
    nodes = int(np.argmin(np.abs(ring.mesh.rim_theta - 0.6))) + np.arange(-6, 7)
    c, s = np.cos(ring.mesh.rim_theta[nodes]), np.sin(ring.mesh.rim_theta[nodes])
    own = c**2 * plain[2 * nodes, 2 * nodes] + s**2 * plain[2 * nodes + 1, 2 * nodes + 1]
    own += 2 * c * s * plain[2 * nodes, 2 * nodes + 1]
    assert wave(own) > 0.2, "between nodes and middles alone"
    assert wave(outward(rim, half[np.abs(half) < weld - 1.5 * length])) < 0.05, "0.2 and 0.6 without"


def test_a_pressure_that_is_smooth_is_answered_as_by_the_mesh(ring):
    """Forces of cos 5 theta on the finer nodes and on the mesh's, in the same units: displacements to 1e-4."""
    rim = EvenRim(ring)
    theta, parts = ring.mesh.rim_theta, rim.parts
    of_place = np.tile([1.0, 2.0], len(theta) // 2) / 3 * 4 * np.pi / len(theta)  # integrals of shape functions
    push = (np.cos(5 * theta) * of_place)[:, None] * np.column_stack([np.cos(theta), np.sin(theta)])
    plain = ring.rim_compliance @ push.ravel()
    fine = rim.theta
    weights = np.tile([1.0, 2.0], len(fine) // 2) / 3 * 4 * np.pi / len(fine)
    pressure = np.cos(5 * fine)[:, None] * np.column_stack([np.cos(fine), np.sin(fine)])
    every = np.arange(2 * len(fine))
    moved = rim.solve_rim(every)[0] @ (pressure * weights[:, None]).ravel() + rim.within * pressure.ravel()
    assert moved.reshape(-1, 2)[::parts].ravel() == pytest.approx(plain, abs=1e-4 * np.abs(plain).max())


def test_with_the_give_within_elements_no_pressure_pushes_back(ring):
    rim = EvenRim(ring)
    near = np.flatnonzero(np.abs(rim.theta) < 0.4)
    dofs = (2 * near[:, None] + np.arange(2)).ravel()
    block = rim.solve_rim(dofs)[0][np.ix_(dofs, dofs)]
    assert block == pytest.approx(block.T, abs=1e-3)  # of 1e5 and more
    by_itself = rim.within * len(rim.theta) / (2 * np.pi)  # of the forces on nodes that a pressure makes
    assert np.linalg.eigvalsh((block + block.T) / 2)[0] > -0.7 * by_itself


@pytest.mark.parametrize("rtol", [1e-3, 1e-4])
@pytest.mark.parametrize("r", [1.008, 1.02])
def test_a_stiff_hoop_has_the_rigid_hoops_largest_force_on_any_floor(r, rtol):
    """Going from node to node on quads it had up to a fifth more (342 for 290 at r = 1.02, rtol 1e-5)."""
    scene = on_stiff_floor(r, 1e4, 1e13, rtol=rtol)
    exact, found = (simulate(scene).pulses[0] for simulate in (rigid.simulate, flexible.simulate))
    assert found.peak_normal_force == pytest.approx(exact.peak_normal_force, rel=5e-3)
    assert found.normal_impulse == pytest.approx(exact.normal_impulse, rel=2e-4)


def test_a_stick_under_a_strong_damper_is_kept():
    """Quads broke it 20 times within its 2e-3; the ring is stiff enough to have the impulses of one a hundred times
    stiffer, which is a rigid rim.
    """
    pulses = [flexible.simulate(on_stiff_floor(1.02, e, 1e9, 50.0, rtol=1e-4)).pulses[0] for e in (1e4, 1e6)]
    assert pulses[0].impulse_ratio == pytest.approx(pulses[1].impulse_ratio, abs=1e-4)
    assert pulses[0].normal_impulse == pytest.approx(pulses[1].normal_impulse, rel=1e-4)


def test_its_forces_come_back_to_the_mesh():
    """Resultant and moment of what the contact's nodes bear are those of the forces on the mesh's."""
    scene = on_stiff_floor(rtol=1e-3)
    motion = flexible.simulate(scene, history=True)
    (kept, *_) = [kept for kept in motion.kept if kept.states]
    state = max(kept.states, key=lambda state: state.res.normal)
    ring = kept.hoop.ring
    load = ring.on_mesh(state.window, state.nodal).reshape(-1, 2)
    assert load.sum(axis=0) == pytest.approx(state.nodal.sum(axis=0), rel=1e-12)
    number = (2 * state.window[0] + np.arange(len(state.nodal))) % len(ring.theta)
    own, back = (
        np.cos(angle) @ force[:, 1] - np.sin(angle) @ force[:, 0]  # about C
        for angle, force in ((ring.theta[number], state.nodal), (ring.ring.mesh.rim_theta, load))
    )
    assert back == pytest.approx(own, abs=1e-6 * np.abs(state.nodal).sum())  # a circle is a parabola to the third order


def test_who_has_one():
    """Floors that are stiff beside the wall, or damped by much; no wall that is thin beside the nodes' distance."""
    assert not feels_places(PULSE, 240)  # the paper's
    assert feels_places(on_stiff_floor(), 240)
    assert feels_places(PULSE.replace(contact={"damping": 50.0}), 240)
    assert not feels_places(on_stiff_floor(1.5, 1.0, 1e12), 240), "a patch that is wider than an element"
    around = ring_of(on_stiff_floor(1.008, rtol=1e-3)).mesh.around
    assert around == elements_of_stout(1 - 1 / 1.008)
    thin = on_stiff_floor(1.003, rtol=1e-3)  # it would take more elements than there may be
    assert ring_of(thin).mesh.around == ring_of(thin.replace(contact={"stiffness": 1e6})).mesh.around
    assert parts_of(thin, ring_of(thin).mesh.around) == 0
    few = on_stiff_floor(1.008, rtol=1e-3, elements=240)
    assert parts_of(few, 240) == 0
