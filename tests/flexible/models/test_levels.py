"""The levels of the hoop against each other: modes, all nodes, geometrically exact."""

import numpy as np
import pytest
from scenes import HOOP

import flexible
from flexible.contact.forces import contact_forces
from flexible.contact.laws.patch import SLIDE_RIGHT
from flexible.contact.points.data import UNDAMPED, Before, Rim
from flexible.contact.points.rim import turned
from flexible.models import select
from flexible.models.chain import ChainHoop
from flexible.models.exact import ExactHoop
from flexible.models.full import FullHoop, NewtonMatrix, _Factored
from flexible.models.reduced import ReducedHoop
from flexible.models.select import FAR, Range, hoop_of
from flexible.ring.choice import ring_of
from flexible.ring.exact import ExactElasticity
from flexible.ring.nodal import inertia
from flexible.start.equilibrium import equilibrium, undeformed
from flexible.start.pose import Pose
from flexible.time.adaptive import MarchError, march
from flexible.time.events import Ends
from rigid import Contact, Friction, Hoop, Kind, Release, Ring, Run, Scene, Solve

WALL = 1 - 1 / 1.02


def scene_b(stiffness=1e8, **solve):
    """An undeformed hoop that touches at phi = 2.9 and rolls at phidot = 4, units R0 = g = m = 1, E b R/(m g) given."""
    return Scene(
        Hoop(k=0.1, r=1.02, mass_ratio=0.1, R=1.02),
        Friction(0.35, 0.3),
        Release(2.9, 4.0),
        Run(t_end=0.1426),
        ring=Ring(bending_stiffness=stiffness * WALL**3 / 12),
        contact=Contact(law="brush", stiffness=1.0404e7, tangential_ratio=1.0, damping=0.0),
        solve=Solve(resolve="all", start="undeformed", **solve),
    )


def measures(hoop, rtol):
    """J_N, J_F and friction loss of scene B, in R0 = g = m = 1."""
    scene = scene_b()
    inner = scene.to_dimensionless()
    start = undeformed(hoop, Pose(2.9, 4.0 * scene.time_unit, 0.0, 0.0, 0.0, Kind.ROLL))
    _, records, _, ended, _ = march(hoop, start, Ends(t=inner.run.t_end), rtol)
    assert not ended
    last = records[-1]
    return np.array([
        last.normal_impulse * scene.impulse_unit,
        last.friction_impulse * scene.impulse_unit,
        last.friction_loss * scene.energy_unit,
    ])  # fmt: skip


@pytest.fixture(scope="module")
def soft_ring():
    """The ring of scene B, and two smooth displacements of it of a third of the wall."""
    ring = ring_of(scene_b().to_dimensionless())
    rng = np.random.default_rng(0)
    fields = []
    for _ in range(2):
        load = np.zeros(len(ring.free))
        load[ring.rim_dofs] = rng.standard_normal(len(ring.rim_dofs))
        field = ring.solve(load)
        fields.append(field * WALL / 3 / np.abs(field).max())
    return ring, *fields


def test_exact_ring_is_the_linear_one_at_rest(soft_ring):
    """The same integration points and elements as the linear form: its stiffness to round-off."""
    ring = soft_ring[0]
    exact = ExactElasticity(ring)
    at_rest = exact.tangent(np.zeros(len(ring.free)))
    assert abs(at_rest - ring.free_stiffness).max() < 1e-14 * abs(ring.free_stiffness).max()
    assert not exact.forces(np.zeros(len(ring.free))).any()


def test_tangents_of_the_exact_ring(soft_ring):
    """Forces from the energy and tangent from the forces, by central differences, to 1e-6."""
    ring, u, v = soft_ring
    exact = ExactElasticity(ring)
    e = 1e-4
    work = (exact.strain_energy(u + e * v) - exact.strain_energy(u - e * v)) / (2 * e)
    assert work == pytest.approx(exact.forces(u) @ v, rel=1e-6)
    found = (exact.forces(u + e * v) - exact.forces(u - e * v)) / (2 * e)
    expected = exact.tangent(u) @ v
    assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()


def test_exact_ring_has_no_strain_when_turned(soft_ring):
    """A turned ring is not strained: the energy of a finite rotation is round-off of what the linear ring finds."""
    ring = soft_ring[0]
    exact = ExactElasticity(ring)
    # on all dofs, the welded ones too
    exact.free = np.arange(ring.basis.N)
    turn = 0.5
    y = ring.position_field
    u = (np.cos(turn) - 1) * y + np.sin(turn) * ring.turned(y)
    linear = u @ ring.stiffness @ u / 2
    assert abs(exact.strain_energy(u)) < 1e-20 * linear + 1e-28


def test_equilibria_of_the_levels():
    """Sag under N, F and inertia: modes against nodes to what 24 modes leave out, nodes against exact to O(strain)."""
    pose = Pose(2.2, 1.0, 0.0, 1.3, -0.2, Kind.ROLL)
    for mass in (0.1, 0.0):
        scene = HOOP.replace(hoop={"mass_ratio": mass})
        hoops = ReducedHoop(scene, modes=24), FullHoop(scene), ExactHoop(scene)
        states = [equilibrium(hoop, pose) for hoop in hoops]
        for state in states:
            assert (state.res.normal, state.res.friction) == pytest.approx((1.3, -0.2), abs=1e-9)
        heights = np.array([state.pos[1] for state in states])
        assert heights[1] == pytest.approx(heights[0], rel=1e-5)
        assert heights[2] == pytest.approx(heights[1], rel=0.01)


@pytest.mark.slow
def test_equilibrium_of_a_soft_ring():
    """E b R/(m g) = 1e6: the sag is several walls, and forces balance; softer than it can carry is said to be so."""
    pose = Pose(2.2, 1.0, 0.0, 1.3, -0.2, Kind.ROLL)
    state = equilibrium(ExactHoop(scene_b(1e6).to_dimensionless()), pose)
    assert state.pos[1] < -4 * WALL
    assert (state.res.normal, state.res.friction) == pytest.approx((1.3, -0.2), abs=1e-9)
    with pytest.raises(MarchError, match="no equilibrium"):
        equilibrium(ExactHoop(scene_b(1e4).to_dimensionless()), pose)


@pytest.mark.slow
def test_reduced_against_all_nodes_in_a_pulse():
    """A massless and a massive hoop through a whole pulse, within the tolerance of the march (1e-2 of the impulse)."""
    for mass in (0.0, 0.1):
        scene = HOOP.replace(hoop={"mass_ratio": mass}, release={"phi0": 2.4, "omega0": 1.5}, solve={"rtol": 3e-3})
        pulses = [flexible.simulate(scene.replace(solve={"level": level})).pulses[0] for level in ("reduced", "full")]
        a, b = (np.array([p.normal_impulse, p.friction_impulse, p.friction_loss]) for p in pulses)
        assert np.abs(a - b).max() < 3e-3 * a[0]


def test_a_linear_ring_without_mass_is_factored_once(monkeypatch):
    """Its matrix never changes: where Newton goes slowly the contact bends, and a new one would be the old one."""
    made = []
    monkeypatch.setattr("flexible.models.full._Factored", lambda *given: made.append(_Factored(*given)) or made[-1])
    scene = HOOP.replace(hoop={"mass_ratio": 0.0}, solve={"level": "full", "rtol": 1e-2}, run={"until": "pulse"})
    flexible.simulate(scene, states=False)
    assert len(made) == 1


@pytest.mark.slow
def test_scene_b_reduced_against_all_nodes():
    """J_N, J_F and loss within 1e-3 of J_N, R0 = g = m = 1; three codes give J_N = 2.149 +- 0.003."""
    scene = scene_b().to_dimensionless()
    reduced, full = (measures(kind(scene), 2e-4) for kind in (ReducedHoop, FullHoop))
    assert np.abs(full - reduced).max() < 1e-3 * full[0]
    assert reduced[0] == pytest.approx(2.149, abs=3e-3)
    assert reduced[2] == pytest.approx(0.0113, abs=4e-4)


@pytest.mark.slow
def test_linear_against_exact():
    """The linear ring's error is of the order of its rotations, N R^2/(E I): a tenth for ten times the stiffness."""
    apart = []
    for stiffness in (2e7, 2e8):
        inner = scene_b(stiffness).to_dimensionless()
        poses = Pose(2.6, 4.0, 0.0, 5.0, -0.5, Kind.ROLL)
        linear, exact = (equilibrium(kind(inner), poses).pos[1] for kind in (FullHoop, ExactHoop))
        apart.append(abs(linear / exact - 1))
    assert apart[1] == pytest.approx(apart[0] / 10, rel=0.3)


def test_level_of_a_scene(caplog):
    """By name, or the chain where the linear ring would be too soft, or all nodes where that is no rod.

    That these take long is said, once.
    """
    select._tell_of_all_nodes.cache_clear()
    assert isinstance(hoop_of(HOOP.replace(solve={"level": "auto"})), ReducedHoop)
    assert type(hoop_of(HOOP.replace(solve={"level": "full"}))) is FullHoop
    for bending, level in ((40.0, "reduced"), (39.999, "chain")):  # below 40, says the README
        assert select.level_of(HOOP.replace(solve={"level": "auto"}, ring={"bending_stiffness": bending})) == level
    soft = HOOP.replace(solve={"level": "auto"}, ring={"bending_stiffness": 1.0})
    assert isinstance(hoop_of(soft), ChainHoop)
    assert not caplog.messages
    for _ in range(2):
        assert isinstance(hoop_of(soft.replace(hoop={"r": 1.5}, solve={"elements": 60})), ExactHoop)
    assert len(caplog.messages) == 1
    assert "too thick for a chain" in caplog.messages[0]


def test_a_linear_ring_that_goes_too_far_says_so():
    """A rim that turns by more than FAR is named with its angle; the exact ring has no such limit."""
    scene = scene_b(1e7, rtol=1e-2, level="reduced").to_dimensionless()
    motion = flexible.simulate(scene)
    assert "too far for a linear ring" in motion.ended
    assert "too far" not in flexible.simulate(HOOP.replace(release={"phi0": 2.4, "omega0": 1.5})).ended
    assert FAR < 0.01  # a percent, as it goes with the rotation
    hoop = ExactHoop(scene)
    far = equilibrium(hoop, Pose(2.2, 1.0, 0.0, 1.3, -0.2, Kind.ROLL))
    rotation = turned(hoop.theta, far.window, far.u)
    assert rotation > FAR
    for model, complains in ((hoop, False), (ReducedHoop(scene), True)):
        limits = Range(model)
        limits(np.array([far.t]), np.array([rotation]), far.pos[2:3])
        assert bool(limits.complaint()) == complains


def newton_errors(hoop, old, beta, dphi):
    """Residuals of full Newton steps with the exact matrix on one smooth step, largest force each."""
    ring, window = hoop.ring, old.window
    dofs = ring.dofs(*window)
    pos_pred, vel_pred = old.pos.copy(), old.vel.copy()
    pos_pred[2] += dphi
    d = np.zeros_like(pos_pred)
    rim, before = Rim(window[0], hoop.vertex), Before(old.pos[:3], old.u, old.bristles)
    sizes = []
    for _ in range(7):
        pos, vel, acc = pos_pred + d, vel_pred + d / beta, d / beta**2
        u = pos[3:][dofs].reshape(-1, 2)
        contact = contact_forces(pos[:3], u, rim, hoop.law.parameters, SLIDE_RIGHT, before, UNDAMPED, True)
        assert contact.res.normal > 0
        own = inertia(ring, pos, vel, acc, beta)
        frame, rest = own.frame - contact.force, own.ring.copy()
        rest[dofs] -= contact.nodal.ravel()
        sizes.append(max(np.abs(frame).max(), np.abs(rest).max()))
        matrix = NewtonMatrix(_Factored(ring, pos[3:], vel[2], acc[2], beta), own, contact.tangent, window)
        step = matrix.solve(frame, rest)
        d[:3] -= step[0]
        d[3:] -= step[1]
    return np.array(sizes)


@pytest.mark.parametrize("kind", [FullHoop, ExactHoop])
def test_newton_converges_quadratically(kind):
    """On a smooth step: the error's exponent doubles with each iteration until round-off, here at the second.

    A tangent of the contact that is 1 % wrong leaves fifty times as much there.
    """
    hoop = kind(HOOP.replace(solve={"elements": 96}))
    old = equilibrium(hoop, Pose(2.2, 1.0, 0.0, 1.3, -0.2, Kind.ROLL))
    sizes = newton_errors(hoop, old, 2e-3, 2e-4)
    floor = 1e-7  # round-off of the elastic forces of a ring this stiff
    assert sizes[2] < floor
    assert (sizes[1:] < np.maximum(10 * sizes[:-1] ** 2, floor)).all()


@pytest.mark.slow
def test_the_softest_ring():
    """E b R/(m g) = 1e5: the ring folds to half its height, and still every element is in order and energy is kept."""
    motion = flexible.simulate(scene_b(1e5, rtol=1e-2, level="exact", elements=120), history=True)
    assert motion.ended == "the time to run is over"
    scale = motion.ledger.initial
    assert abs(motion.ledger.numerical_loss) < 1e-2 * scale
    kept = motion.kept[-1]
    exact = kept.hoop.ring.exact
    furthest = max(kept.states, key=lambda state: np.abs(state.pos[3:]).max())
    assert np.abs(furthest.pos[3:]).max() > 0.3
    first, second = exact._strain(furthest.pos[3:])[0]  # columns of F
    assert (first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]).min() > 0.5


@pytest.mark.slow
@pytest.mark.usefixtures("uneven")
def test_a_thick_pulse_against_all_nodes():
    """A wall of a tenth of R, linear, on one mesh: a percent of the largest force, a thousandth of J_N.

    The mesh is coarse, and leaves the same to both. The largest force of all nodes is known no better: with twice as
    many elements 0.6 % of it changes from rtol 3e-4 to 1e-4, and 0.7 % with 4 through the wall. At these tolerances
    either ring may go another way, J_F 1.6 % off or 7e-4 of J_N, by where its steps lie; from 4e-5 down both go this.
    """
    scene = HOOP.replace(
        hoop={"k": 0.2, "r": 1.1}, ring={"bending_stiffness": 20.0}, contact={"stiffness": 1e7, "damping": 1.0},
        solve={"rtol": 3e-5, "elements": 120},
    )  # fmt: skip
    reduced, full = (flexible.simulate(scene.replace(solve={"level": kind})).pulses[0] for kind in ("reduced", "full"))
    assert reduced.normal_impulse == pytest.approx(full.normal_impulse, rel=1e-3)
    assert reduced.peak_normal_force == pytest.approx(full.peak_normal_force, rel=0.01)
    assert reduced.friction_impulse == pytest.approx(full.friction_impulse, rel=0.01)
    assert reduced.friction_loss == pytest.approx(full.friction_loss, rel=0.01)
