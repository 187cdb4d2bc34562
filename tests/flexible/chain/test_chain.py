"""The hoop on a chain of parts: its inertia, free flight, equilibria and pulses against the other levels."""

import numpy as np
import pytest
from scenes import HOOP, energy, flying, steps_of

import flexible
from flexible.chain.bordered import no_blocks
from flexible.chain.mass.inertia import energies, inertia, inertia_tangent, momenta
from flexible.chain.whole import moved, sections
from flexible.models.chain import ChainHoop
from flexible.models.exact import ExactHoop
from flexible.models.reduced import ReducedHoop
from flexible.models.select import hoop_of
from flexible.start.equilibrium import equilibrium
from flexible.start.pose import Pose
from flexible.time.adaptive import restart
from rigid import Kind

COARSE = HOOP.replace(solve={"elements": 48})


@pytest.fixture(scope="module")
def hoop():
    return ChainHoop(COARSE)


def motion(hoop, seed=0, size=0.1):
    """Position, velocity, acceleration with everything in motion."""
    rng = np.random.default_rng(seed)
    n = 3 + hoop.coordinates
    pos = size * rng.standard_normal(n)
    pos[2] = 1.1
    return pos, rng.standard_normal(n), rng.standard_normal(n)


def forces(hoop, pos, vel, acc, beta=1.0):
    ring = hoop.ring
    blocks = no_blocks(ring.sections + 2)
    frame, force = np.zeros(3), np.zeros((ring.sections + 2, 3))
    q, qv, qa = (sections(x) for x in (pos, vel, acc))
    inertia(ring.chain, (pos, q), (vel, qv), (acc, qa), frame, force)
    inertia_tangent(ring.chain, (pos, q), (vel, qv), (acc, qa), beta, blocks)
    return np.concatenate([frame, force[1:-1].ravel()]), blocks


def test_tangent_of_the_inertia(hoop):
    """Central differences, 1e-6 of the largest."""
    beta = 0.3
    pos, vel, acc = motion(hoop)
    rng = np.random.default_rng(5)
    way = rng.standard_normal(len(pos))
    blocks = forces(hoop, pos, vel, acc, beta)[1]
    exact = np.zeros_like(way)
    exact[:3] = blocks.corner[:3, :3] @ way[:3]
    rows = way[3:].reshape(-1, 3)
    exact[:3] += np.einsum("iba,ib->a", blocks.rows[1:-1, :, :3], rows)
    by_rows = np.einsum("iab,ib->ia", blocks.diagonal[1:-1], rows) + blocks.columns[1:-1, :, :3] @ way[:3]
    by_rows[-1] += blocks.up[-1] @ rows[0]  # the wall over the weld and beside it moves with both
    by_rows[0] += blocks.down[-1] @ rows[-1]
    exact[3:] = by_rows.ravel()
    step = 1e-6 * way
    after, before = (forces(hoop, pos + d, vel + d / beta, acc + d / beta**2, beta)[0] for d in (step, -step))
    assert np.abs((after - before) / 2e-6 - exact).max() < 1e-6 * np.abs(exact).max()


def test_power_of_the_inertia(hoop):
    """Force times velocity is the rate of kinetic energy and gravity, for any motion."""
    pos, vel, acc = motion(hoop, 1)
    ring = hoop.ring

    def held(t):
        x, v = pos + t * vel + t * t / 2 * acc, vel + t * acc
        return sum(energies(ring.chain, x, sections(x), v, sections(v)))

    rate = (held(1e-5) - held(-1e-5)) / 2e-5
    assert rate == pytest.approx(forces(hoop, pos, vel, acc)[0] @ vel, rel=1e-7)


def test_momenta_are_the_mass_times_rates(hoop):
    """What a change of accelerations adds to the forces."""
    pos, vel, acc = motion(hoop, 2)
    frame, force = np.empty(3), np.empty((hoop.ring.sections + 2, 3))
    momenta(hoop.ring.chain, pos, sections(pos), vel, sections(vel), frame, force)
    expected = forces(hoop, pos, vel, acc + vel)[0] - forces(hoop, pos, vel, acc)[0]
    assert np.concatenate([frame, force[1:-1].ravel()]) == pytest.approx(expected, rel=1e-10, abs=1e-10)


def momentum(hoop, state):
    """Linear momentum (x, y)."""
    frame, force = np.empty(3), np.empty((hoop.ring.sections + 2, 3))
    pos, vel = state.pos, state.vel
    momenta(hoop.ring.chain, pos, sections(pos), vel, sections(vel), frame, force)
    return frame[:2]


def soft_flight(step, t_end=0.15):
    """A hoop of E I = 1 that flies, turns, and swings so far that its rim moves by a twentieth of R."""
    hoop = ChainHoop(COARSE.replace(ring={"bending_stiffness": 1.0}, hoop={"mass_ratio": 1.0}))
    pos, vel = np.zeros(3 + hoop.coordinates), np.zeros(3 + hoop.coordinates)
    pos[1:3] = 5.0, 0.4
    vel[:3] = -0.5, 0.2, 1.5
    swing = hoop.ring.shape.shapes[:, :1][:, 0]
    vel[3:] = swing / np.abs(swing.reshape(-1, 3)[:, :2]).max()
    _, records, states = steps_of(hoop, restart(hoop, flying(hoop, pos, vel), 0), t_end, step)
    return hoop, records, states


def test_free_flight_of_a_soft_hoop():
    """Linear and angular momentum, less gravity's, and energy drift at the integrator's order, three or better.

    They are kept to the integrator's error, not to round-off: the unknowns are positions in a turning frame. The
    largest of the flight, as errors go to and fro.
    """
    errors = []
    for step in (1e-3, 2.5e-4):
        hoop, records, states = soft_flight(step)
        assert np.abs(sections(states[-1].pos)[:, :2]).max() > 0.05
        weight = 1 + hoop.ring.chain.body.ring_mass
        held = np.array(
            [[*momentum(hoop, s), angular(hoop, s), energy(r)] for s, r in zip(states, records, strict=True)]
        )
        held[:, 1] += weight * np.array([state.t for state in states])
        errors.append(np.abs(held - held[0]).max(axis=0))
    rates = np.log2(np.array(errors[0]) / np.array(errors[1])) / 2
    assert (rates > 2.7).all(), errors
    assert max(errors[1]) < 1e-5


def angular(hoop, state):
    """Angular momentum about the centre of mass, clockwise: free flight keeps it."""
    ring, pos, vel = hoop.ring, state.pos, state.vel
    (body, rod, ends), q, rate = ring.chain, sections(pos), sections(vel)
    y, w = rod.place + q[:, :2], vel[2]
    mass = rod.mass
    c, s = np.cos(pos[2]), np.sin(pos[2])
    v1, v2 = (vel[0] + w) * s + vel[1] * c, (vel[0] + w) * c - vel[1] * s
    v = np.array([v1, v2]) + rate[:, :2] + w * np.column_stack([-y[:, 1], y[:, 0]])
    total = 1 + body.ring_mass
    end, end_rate = (rows[[1, -2]].ravel() for rows in (q, rate))
    sum1, sum2 = moved = ends.first @ end
    centre = (mass @ y + moved + [body.weld_moment + body.offset, 0.0]) / total
    rigid = np.array([(body.weld_mass + 1) * v1, (body.weld_mass + 1) * v2 + w * (body.weld_moment + body.offset)])
    p = mass @ v + rigid + ends.first @ end_rate + w * np.array([-sum2, sum1])
    about = mass @ (y[:, 0] * v[:, 1] - y[:, 1] * v[:, 0]) + rod.turning @ (w + rate[:, 2])
    about += body.weld_moment * v2 + body.weld_inertia * w
    about += sum1 * v2 - sum2 * v1 + (ends.turning + ends.gyro @ end) @ end_rate
    about += w * (2 * ends.stretching + ends.mass @ end) @ end
    about += body.offset * (v2 + w * body.offset) + body.disk_inertia * w
    return about - (centre[0] * p[1] - centre[1] * p[0])


@pytest.mark.slow
@pytest.mark.parametrize(("stiffness", "pose"), [
    (10.0, Pose(2.6, 3.0, 0.0, 5.0, 0.5, Kind.ROLL)),
    (10.0, Pose(3.0, 3.0, 0.0, 20.0, 2.0, Kind.ROLL)),
    (1.0, Pose(2.2, 1.0, 0.0, 1.3, -0.2, Kind.ROLL)),
])  # fmt: skip
def test_equilibria_against_all_nodes(stiffness, pose):
    """Sag of soft rings under N, F and inertia, and their strain energy, against the exact ring on the same mesh.

    The parts bend by up to 0.02 each, the square of which is 4e-4. Over a section the rim gives way by up to
    2/(E b) too much, which is kept from pushing back.
    """
    scene = HOOP.replace(ring={"bending_stiffness": stiffness}, hoop={"mass_ratio": 0.05})
    chain, exact = ChainHoop(scene), ExactHoop(scene, through=2)
    a, b = equilibrium(chain, pose), equilibrium(exact, pose)
    assert [a.res.normal, a.res.friction] == pytest.approx([pose.normal_force, pose.friction_force], abs=1e-8)
    assert a.pos[1] == pytest.approx(b.pos[1], rel=5e-4, abs=2 * pose.normal_force / chain.ring.stiffness)
    assert chain.energies(a)[2] == pytest.approx(exact.energies(b)[2], rel=5e-4)


def test_another_window_leaves_the_rim_where_it_was(hoop):
    """Newton knows where a soft rim is by forces with a tolerance, its compliance times which is many a patch's depth.

    What the rim's forces make of it is not asked again where it is known.
    """
    pose = Pose(2.6, 3.0, 0.0, 5.0, 0.5, Kind.ROLL)
    state = equilibrium(hoop, pose)
    state = state._replace(u=state.u + 1e-6 * np.random.default_rng(3).standard_normal(state.u.shape))
    first, count = state.window
    found = moved(hoop.arrays, state, (first - 1, count + 2))[0]
    assert np.abs(found[2:-2] - state.u).max() < 1e-15  # rounding


@pytest.mark.parametrize("level", [ChainHoop, ReducedHoop])
@pytest.mark.parametrize(("elements", "close"), [(240, 0.18), pytest.param(480, 0.04, marks=pytest.mark.slow)])
def test_a_stiff_floor_dents_the_wall_as_hertz_has_it(level, elements, close):
    """Half-width of a line contact in plane stress, a^2 = 4 N R/(pi E b), on a floor 1e5 times as stiff as the wall.

    Wherever it lies on the mesh, of elements as wide as a and half as wide. The wall is eight times as thick as a: the
    ring bends there, which makes R larger, and a by a few hundredths. When nothing gave way within an element, the
    patch was a twentieth as wide.
    """
    wall = 1 - 1 / 1.3
    hoop = level(
        HOOP.replace(
            hoop={"r": 1.3},
            ring={"bending_stiffness": 650 * wall**3},
            contact={"stiffness": 1e12},
            solve={"rtol": 1e-4, "elements": elements},
        )
    )
    half = np.sqrt(4 * 5.0 / (np.pi * hoop.ring.stiffness))
    assert wall == pytest.approx(8 * half, rel=0.02)
    assert 2 * np.pi / 240 == pytest.approx(half, rel=0.1)
    for share in np.linspace(0, 1, 5, endpoint=False):
        state = equilibrium(hoop, Pose(2.2 + share * 2 * np.pi / elements, 1.0, 0.0, 5.0, 0.5, Kind.ROLL))
        assert state.res.length == pytest.approx(2 * half, rel=close)


def test_a_stiff_hoop_is_the_reduced_one():
    """A pulse at E I = 1e3, where the linear ring is exact: impulses to the tolerance of the march."""
    scene = HOOP.replace(release={"phi0": 2.4, "omega0": 1.5})
    pulses = [flexible.simulate(scene.replace(solve={"level": level})).pulses[0] for level in ("reduced", "chain")]
    a, b = (np.array([p.normal_impulse, p.friction_impulse, p.friction_loss]) for p in pulses)
    assert np.abs(a - b).max() < 1e-3 * a[0]


def test_level_by_name():
    assert isinstance(hoop_of(COARSE.replace(solve={"level": "chain"})), ChainHoop)


def test_a_damped_soft_pulse_is_gone_through():
    """E I = 3, whose wall gives way: steps of 1e-9 after an event, in which the damper's onset is a sharp bend."""
    scene = HOOP.replace(
        ring={"bending_stiffness": 3.0}, hoop={"mass_ratio": 0.05}, friction={"mu_s": 0.35, "mu": 0.3},
        release={"phi0": np.radians(10), "omega0": 0.0}, run={"until": "pulse"},
        contact={"stiffness": 1e8, "damping": 1.0}, solve={"level": "chain", "rtol": 3e-3},
    )  # fmt: skip
    motion = flexible.simulate(scene)
    assert motion.completed, motion.ended
    assert len(motion.pulses) == 1


@pytest.mark.slow
def test_a_soft_pulse_against_all_nodes():
    """The first pulse at E I = 10, where the rim turns by 0.03, on the same mesh: a percent in all that is measured.

    The mesh is coarse and the floor softer than in `hoop bench soft`, which has this hoop on 240 elements: what they
    leave is the same for both.
    """
    scene = HOOP.replace(
        ring={"bending_stiffness": 10.0}, hoop={"mass_ratio": 0.05}, contact={"stiffness": 1e7},
        solve={"rtol": 1e-3, "elements": 120, "through": 2},
    )  # fmt: skip
    found = []
    for level in ("chain", "exact"):
        pulse = flexible.simulate(scene.replace(solve={"level": level})).pulses[0]
        ratio = pulse.friction_impulse / pulse.normal_impulse
        found.append([
            pulse.normal_impulse, ratio, pulse.peak_normal_force, pulse.friction_loss, pulse.time_off_floor,
        ])  # fmt: skip
    assert found[0] == pytest.approx(found[1], rel=0.01)


@pytest.mark.slow
def test_a_thick_soft_pulse_against_all_nodes():
    """A wall of a tenth of R, the disk over it a quarter of the hoop: the floor pushes where the weld's own field is.

    The chain's rim misses the mesh's by some thousandths of what loads move it there, and the largest force is that of
    a vibration: a fiftieth of it, a hundredth of friction and its loss, a thousandth of J_N. Both have the same mesh,
    which is coarse: what it leaves is the same for both.
    """
    thick = HOOP.replace(
        hoop={"k": 0.2, "r": 1.12, "mass_ratio": 0.1}, ring={"bending_stiffness": 10.0},
        contact={"stiffness": 1e7, "damping": 1.0}, solve={"rtol": 1e-3, "elements": 120, "through": 2},
    )  # fmt: skip
    chain, exact = (flexible.simulate(thick.replace(solve={"level": kind})).pulses[0] for kind in ("chain", "exact"))
    assert chain.normal_impulse == pytest.approx(exact.normal_impulse, rel=1e-3)
    assert chain.friction_impulse == pytest.approx(exact.friction_impulse, rel=0.01)
    assert chain.friction_loss == pytest.approx(exact.friction_loss, rel=0.01)
    assert chain.peak_normal_force == pytest.approx(exact.peak_normal_force, rel=0.02)
