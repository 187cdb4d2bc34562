"""Stress and energy at the nodes against exact solutions, and against the model that marched."""

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from flexible import simulate, write_fields
from flexible.contact.laws.listing import sticks
from flexible.models.full import FullHoop
from flexible.models.reduced import ReducedHoop
from flexible.output.interior import interior_of
from flexible.output.patch import profile
from flexible.output.recovery import ExactInterior, Interior
from flexible.ring.fem import Ring
from flexible.start.equilibrium import equilibrium
from flexible.start.pose import Pose
from meshes import hoop_stress, read, ring_mesh
from rigid import Kind, load_scene
from rigid import simulate as simulate_rigid

POISSON = 0.3


def rotating(around, through, inner=1 / 1.2):
    """Hoop and radial stress at the nodes of a free ring rotating at omega = 1, with E = density = 1, b = 1.

    K u = M Y, the rigid motions held by three dofs that do not move: u2 at theta = 0 and pi, u1 at pi/2.
    """
    mesh = ring_mesh(inner, 1.0, around, through, np.pi / 12)
    ring = Ring(mesh, POISSON)
    load = ring.area * (ring.mass @ ring.position_field)
    nodes = [np.hypot(*(mesh.points - mesh.outer * np.array(at)).T).argmin() for at in ((1, 0), (-1, 0), (0, 1))]
    held = [mesh.node_dofs[nodes[0], 1], mesh.node_dofs[nodes[1], 1], mesh.node_dofs[nodes[2], 0]]
    free = np.setdiff1d(np.arange(ring.basis.N), held)
    u = np.zeros(ring.basis.N)
    u[free] = spsolve(ring.stiffness[free][:, free].tocsc(), load[free])
    stress, density, _ = Interior(ring, 1.0, 1.0).stress(u[mesh.node_dofs][..., None])
    around_ = hoop_stress(mesh, stress[..., 0])
    return mesh, around_, stress[:, 0, 0] + stress[:, 1, 0] - around_, density[:, 0]


def test_stress_of_a_rotating_ring_converges_to_lames():
    """PHYSICS, section 4, no. 5, a = 1/1.2 and b = 1; nodal recovery is second order.

    sigma_theta = (3 + nu)/8 (a^2 + b^2 + a^2 b^2/x^2 - (1 + 3 nu)/(3 + nu) x^2),
    sigma_r = (3 + nu)/8 (a^2 + b^2 - a^2 b^2/x^2 - x^2).
    """
    a, errors, radial_errors = 1 / 1.2, [], []
    counts = [24, 48, 96]
    for i, count in enumerate(counts):
        mesh, hoop, radial, _ = rotating(count, 2**i)
        x, front = mesh.radius, (3 + POISSON) / 8
        exact = front * (a**2 + 1 + a**2 / x**2 - (1 + 3 * POISSON) / (3 + POISSON) * x**2)
        exact_radial = front * (a**2 + 1 - a**2 / x**2 - x**2)
        errors.append(np.abs(hoop - exact).max())
        radial_errors.append(np.abs(radial - exact_radial).max())
    for found in (errors, radial_errors):
        order = -np.polyfit(np.log(counts), np.log(found), 1)[0]
        assert order == pytest.approx(2, abs=0.12), found
    assert errors[-1] < 1e-3  # of a stress of 0.86


def test_energy_of_a_field_is_half_its_work():
    """u K u / 2 from the elements; its density at the nodes integrates to that of the quads as well as it is recovered.

    The corners of the weld, cut finer, are in the elements' energies and have no density.
    """
    mesh = ring_mesh(0.9, 1.0, 60, 2, 0.2)
    ring = Ring(mesh, POISSON)
    x, y = mesh.points.T
    u = np.column_stack([x**2 - 0.3 * y, np.sin(2 * y) + x * y])
    flat = np.zeros(ring.basis.N)
    flat[mesh.node_dofs] = u
    interior = Interior(ring, 7.0, 1.0)
    quads = 3.5 * flat @ (ring.stiffness @ flat)
    exact = quads + 3.5 * flat @ (ring.corners.stiffness(ring.basis.N) @ flat)
    by_element = interior.element_energy(u[..., None])
    assert by_element.shape == (len(mesh.quad9), 1)
    assert by_element.sum() == pytest.approx(exact, rel=1e-12)
    density = interior.stress(u[..., None]).density
    weights = ring.mass @ np.ones(ring.basis.N) * ring.area
    assert weights[mesh.node_dofs[:, 0]] @ density[:, 0] == pytest.approx(quads, rel=2e-3)


def test_the_exact_ring_feels_no_rotation_and_stretches_as_it_should():
    """A rigid rotation of 0.4 leaves it without stress; a pure stretch has Cauchy's stress lambda S_11."""
    mesh = ring_mesh(0.9, 1.0, 40, 1, 0.2)
    ring = Ring(mesh, POISSON)
    exact, linear = (kind(ring, 5.0, 1.0) for kind in (ExactInterior, Interior))
    cos, sin = np.cos(0.4), np.sin(0.4)
    turned = mesh.points @ (np.array([[cos, sin], [-sin, cos]]) - np.eye(2))
    assert np.abs(exact.stress(turned[..., None])[0]).max() < 1e-12
    assert np.abs(linear.stress(turned[..., None])[0]).max() > 0.1
    assert exact.element_energy(turned[..., None]).max() < 1e-20
    # stretched by 1.1 along y1 while y2 contracts freely: E22 = -nu E11
    e11 = (1.1**2 - 1) / 2
    narrow = np.sqrt(1 - 2 * POISSON * e11)
    stress, density, _ = exact.stress((mesh.points * [0.1, narrow - 1])[..., None])
    np.testing.assert_allclose(stress[:, 0, 0], 5 * e11 * 1.1 / narrow, rtol=1e-10)
    np.testing.assert_allclose(stress[:, 1:, 0], 0, atol=1e-10)
    np.testing.assert_allclose(density[:, 0], 5 * e11**2 / 2, rtol=1e-10)


def test_stress_along_a_wall_that_has_turned_is_what_it_was_before():
    """A ring blown up by a twentieth, then turned by 0.7 about its centre, and so by all that a wall can."""
    mesh = ring_mesh(0.9, 1.0, 40, 1, 0.2)
    exact = ExactInterior(Ring(mesh, POISSON), 5.0, 1.0)
    cos, sin = np.cos(0.7), np.sin(0.7)
    blown = 0.05 * mesh.points
    turned = (mesh.points + blown) @ np.array([[cos, sin], [-sin, cos]]) - mesh.points
    shear = np.column_stack([0.1 * mesh.points[:, 1], 0 * mesh.points[:, 1]])  # no longer alike in all directions
    for u, v in ((blown, turned), (shear, (mesh.points + shear) @ np.array([[cos, sin], [-sin, cos]]) - mesh.points)):
        before, after = (exact.stress(field[..., None]) for field in (u, v))
        hoop = [hoop_stress(mesh, found.stress[..., 0], found.along[..., 0]) for found in (before, after)]
        np.testing.assert_allclose(hoop[1], hoop[0], rtol=0, atol=1e-11)
        assert np.abs(hoop[0]).max() > 0.2
    assert np.abs(hoop_stress(mesh, after.stress[..., 0]) - hoop[0]).max() > 0.1  # along the ring at rest


CASES = {
    "massless": ("paper-3.3-massless", {}),
    "light": ("paper-3.3-light", {}),
    "brush": ("paper-3.3-light", {"law": "brush"}),
    "damped": ("paper-3.3-light", {"damping": 1.0}),
}


@pytest.fixture(scope="module", params=CASES)
def kept(request):
    """The states of a first pulse to behind its middle, at a tolerance at which Newton finds forces to 1e-9.

    Elements longer than the wall is thick give way by themselves; what shorter ones do is the contact's.
    """
    name, contact = CASES[request.param]
    pulse = simulate_rigid(load_scene(name)).pulses[0]
    run = {"until": None, "turns": None, "t_end": 0.4 * pulse.t_start + 0.6 * pulse.t_end}
    scene = load_scene(name).replace(run=run, solve={"rtol": 1e-6, "elements": 240}, contact=contact)
    return simulate(scene, history=True).kept[0]


@pytest.mark.slow
def test_the_rim_is_where_the_contact_saw_it(kept):
    interior = interior_of(kept.hoop)
    states = kept.states[::10]
    u = interior.displacement(states)
    rim = u[interior.mesh.rim_nodes]
    largest = np.abs(rim).max()
    for number, state in enumerate(states):
        window = (2 * state.window[0] + np.arange(2 * state.window[1] + 1)) % len(rim)
        np.testing.assert_allclose(rim[window, :, number], state.u, rtol=0, atol=1e-9 * largest)
    assert (u[interior.mesh.weld_nodes] == 0).all()


def test_the_energy_of_the_elements_is_the_ledgers(kept):
    interior = interior_of(kept.hoop)
    states = kept.states[::10]
    energy = interior.element_energy(interior.displacement(states)).sum(axis=0)
    known = [kept.hoop.energies(state)[2] for state in states]
    np.testing.assert_allclose(energy, known, rtol=1e-7, atol=1e-9 * max(known))


def test_pressure_and_traction_add_up_to_the_forces(kept):
    """To round-off."""
    for state in kept.states[::7]:
        along = profile(kept.hoop, state)
        normal = np.trapezoid(along.pressure, along.theta)
        friction = np.trapezoid(along.traction, along.theta)
        size = 1e-9 + state.normal_force
        assert normal == pytest.approx(state.normal_force, abs=1e-9 * size)
        # the drag of a damper is shared like the pressure, which ends a little earlier than the bristles do
        digits = 1e-4 if sticks(kept.hoop.law.parameters, state.mode) and kept.hoop.relaxation > 0 else 1e-9
        assert friction == pytest.approx(state.friction_force, abs=digits * size)
        assert (along.pressure >= 0).all()
        assert ((along.stick != 0) >= (along.pressure > 0)).all()


def test_modes_that_come_back_turned_among_themselves_change_nothing(kept):
    """The eigensolver's signs, and its basis where frequencies are nearly equal, are its own: asked again, for more
    modes, it may return others. The modes that were integrated are those that are drawn.
    """
    interior = interior_of(kept.hoop)
    state = [kept.states[len(kept.states) // 2]]
    before = interior.displacement(state)
    if kept.hoop.scene.hoop.mass_ratio == 0:
        pytest.skip("a massless ring has no modes")
    ring = interior.ring
    values, shapes = ring.modes(interior.reduced.rim_shapes.shape[1])
    again = interior_of(kept.hoop)
    original = dict(ring.__dict__["_modes"])
    turned = shapes * np.where(np.arange(shapes.shape[1]) % 2, -1, 1)
    turned[:, :2] = shapes[:, :2] @ np.array([[0.6, -0.8], [0.8, 0.6]])
    ring.__dict__["_modes"].update(dict.fromkeys(original, (values, turned)))
    try:
        np.testing.assert_allclose(again.displacement(state), before, rtol=1e-12, atol=1e-20)
    finally:
        ring.__dict__["_modes"].update(original)


def test_a_ring_that_spins_is_under_lames_stress():
    """With 6 modes, which alone hold next to nothing of it. The disk, a ten-thousandth of the ring, loads it by pi
    times that. Weld and weight bend the wall by a percent, with opposite signs at its two faces: their mean has none.
    """
    omega, inner, mass = 300.0, 0.95, 1e4
    scene = load_scene("paper-3.3-light").replace(
        hoop={"r": 1 / inner, "mass_ratio": mass},
        release={"phi0_deg": 90, "omega0": omega},
        ring={"bending_stiffness": 1e9},
        run={"t_end": 1e-4},
        contact={"stiffness": 1e12},
        solve={"rtol": 1e-2, "resolve": "all"},
    )
    motion = simulate(scene, history=True)
    kept, nu = motion.kept[0], scene.ring.poisson
    interior = interior_of(kept.hoop)
    stress = interior.stress(interior.strained(kept.states[:1]))[0][..., 0]
    mesh = interior.mesh
    found, away = hoop_stress(mesh, stress), np.abs(np.arctan2(*mesh.points.T[::-1])) > np.radians(25)
    density = mass / (np.pi * (1 - inner**2))
    means, lame = [], []
    for x in (inner, 1.0):
        means.append(found[away & np.isclose(np.hypot(*mesh.points.T), x, rtol=1e-9)].mean())
        squares = 1 + inner**2 + (inner / x) ** 2 - (1 + 3 * nu) / (3 + nu) * x**2
        lame.append(density * omega**2 * (3 + nu) / 8 * squares)
    assert np.mean(means) == pytest.approx(np.mean(lame), rel=1e-3)


MASS = 5.0  # disk and ring
POSES = {
    "at rest": Pose(np.pi, 0.0, 0.0, MASS, 0.0, Kind.ROLL),
    "rolling": Pose(2.2, 3.0, 0.0, 1.3 * MASS, -0.2 * MASS, Kind.ROLL),
}


@pytest.mark.parametrize("name", POSES)
def test_a_ring_in_six_modes_is_under_the_stress_of_all_nodes(name):
    """Under its weight, four times its disk's, and in the frame's motion: what the modes leave out yields statically.

    In equilibrium no more is left out than omega^2 over the least square of their frequencies, 9/4.5e6 = 2e-6.
    """
    pose = POSES[name]
    scene = load_scene("paper-3.3-light").replace(
        hoop={"mass_ratio": MASS - 1}, ring={"bending_stiffness": 1e4}, solve={"elements": 120}
    )
    found = []
    for hoop in (ReducedHoop(scene, modes=6), FullHoop(scene)):
        state = equilibrium(hoop, pose)
        a_x, a_y, alpha = pose.accelerations(hoop)
        rates, acc = np.zeros_like(state.vel), np.zeros_like(state.acc)
        rates[2] = pose.omega
        acc[:3] = a_x - alpha, a_y - 1, alpha  # of slip, height and phi; a_y is beyond free fall
        state = state._replace(vel=rates, acc=acc)
        interior = interior_of(hoop)
        found.append(hoop_stress(interior.mesh, interior.stress(interior.strained([state]))[0][..., 0]))
    few, all_nodes = found
    np.testing.assert_allclose(few, all_nodes, rtol=0, atol=1e-5 * np.abs(all_nodes).max())


@pytest.mark.parametrize("r", [1.25, 1.0])
def test_the_disk_lies_against_the_inner_rim(tmp_path, r):
    """Its radius is k times the inner one; its centre is 1 - k of that from the hoop's, at the angle of the motion.

    Of a hoop without thickness the centre is where its mass is, and the radius less by the wall.
    """
    scene = load_scene("paper-3.3-massless").replace(hoop={"k": 0.4, "r": r}, run={"t_end": 0.05})
    motion = simulate(scene, history=True)
    write_fields(motion, tmp_path, times=[0.05], fields=("displacement",))
    points = read(tmp_path)[0].blocks["disk"].points[:, :2]
    state = motion.at(0.05)
    centre, rim = points[0], points[1:]
    assert np.linalg.norm(rim - centre, axis=1) == pytest.approx(0.4 / 1.25 if r > 1 else 0.4 - scene.wall)
    far = 0.6 / r * np.array([np.sin(state.phi), np.cos(state.phi)])
    assert centre - [state.x_C, state.y_C] == pytest.approx(far, abs=1e-12)
