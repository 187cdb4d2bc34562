"""Off the floor and back: lift-off, parabola, landing with friction, jam; closed-form cases and laws of mechanics."""

from __future__ import annotations

from math import copysign, cos, inf, nan, pi, radians, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rigid import Aloft, Friction, Hoop, Kind, Landing, Release, Run, Scene, SceneError, simulate
from rigid.kernel.angle import chart
from rigid.kernel.layout import ANGLE, OMEGA, SLIP, STATE, TOP, UN
from rigid.phases.flight import height, touch_down
from rigid.phases.impact import strike
from rigid.record.pulse import energy, released
from rigid.sampler import parameters


@pytest.mark.parametrize("phi0", [0.3, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("k", [0.02, 0.2, 0.6])
def test_no_hop_from_rest(k, phi0):
    """Released at rest the hoop never leaves the floor, whatever k and friction (N > 0 always)."""
    for mu in (0.0, 0.2, 0.5):
        motion = simulate(Scene(Hoop(k), Friction(1.2 * mu, mu), Release(phi0), Run(turns=6)))
        assert all(phase.kind != Kind.FLIGHT for phase in motion.phases)


def lifting(omega):
    """Spun up at release, the hoop slips round once and hops."""
    scene = Scene(Hoop(0.1), Friction(0.48, 0.4), Release(radians(30), omega), Run(turns=2))
    motion = simulate(scene)
    index = next(
        i for i, p in enumerate(motion.phases) if i and p.kind == Kind.FLIGHT and motion.phases[i - 1].kind == Kind.SPIN
    )
    return motion, motion.phases[index]


@pytest.mark.parametrize("omega", [1.0, 1.5, 2.0])
def test_lift_off_lies_in_the_last_quadrant(omega):
    """Rotating clockwise, e c phidot^2 rises through 1 between 270 and 360 degrees only; N falls to 0 there."""
    motion, flight = lifting(omega)
    state = motion.at(flight.t_start)
    assert state.omega > 0
    assert 1.5 * pi < flight.phi_start % (2 * pi) < 2 * pi
    assert motion.scene.hoop.e * cos(state.phi) * state.omega**2 == pytest.approx(1, abs=1e-12)
    # N is linear in time on its way to zero
    before = motion.at(flight.t_start - np.array([1e-6, 2e-6])).normal_force
    assert before[1] / before[0] == pytest.approx(2, abs=1e-4)


def test_flight_is_a_parabola_with_constant_rotation():
    motion, flight = lifting(1.5)
    t = np.linspace(flight.t_start, flight.t_end, 9)[1:-1]
    states = motion.at(t)
    e = motion.scene.hoop.e
    x, y = states.x_C + e * np.sin(states.phi), states.y_C + e * np.cos(states.phi)
    assert np.polyfit(t, y, 2)[0] == pytest.approx(-0.5, abs=1e-9)
    assert np.abs(np.diff(x, 2)).max() < 1e-12
    assert np.ptp(states.omega) < 1e-14
    assert np.ptp(states.energy) < 1e-13
    assert (states.y_C > 1).all()
    after = motion.phases[motion.phases.index(flight) + 1]
    assert after.kind == Kind.IMPACT


@pytest.mark.parametrize("omega", [0.5, 3.0, 40.0, 3e3])
def test_touch_down_is_the_first(omega):
    """No instant before the touch-down found has the hoop below the floor, on a grid finer than a rotation."""
    e, un, phi = 0.9, 0.8, 5.0
    a, top, _ = chart(phi, 1.0, 0.0)
    time = touch_down(e, 0.0, un, omega, a, top)
    grid = np.linspace(0, time, 20001)[1:-1]
    heights = [height(e, 0.0, un, omega, sin(phi), cos(phi), t)[0] for t in grid]
    assert min(heights) > -1e-9
    # the rim moves by omega times the round-off of the time
    assert height(e, 0.0, un, omega, sin(phi), cos(phi), time)[0] == pytest.approx(0, abs=1e-14 + 2e-16 * omega * time)


def at_landing(par, phi, omega, slip, un):
    state = [0.0] * STATE
    state[ANGLE], state[TOP], _ = chart(phi, 1.0, 0.0)
    state[OMEGA], state[SLIP], state[UN] = omega, slip, un
    released(par, state)
    return state


@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
def test_smooth_landing(restitution):
    """Without friction the normal velocity is reversed times the coefficient; with 1 energy is kept."""
    par = parameters(Scene(Hoop(0.3), Friction(0, 0), Release(1.0)))
    state = at_landing(par, 5.0, 2.0, 0.7, -1.3)
    before = energy(par, state)
    strike(par, state, restitution)
    assert state[UN] == pytest.approx(1.3 * restitution, abs=1e-14)
    lost = before - energy(par, state)
    e, gyr = par[0], par[2]
    mass = gyr / (gyr + (e * sin(5.0)) ** 2)
    assert lost == pytest.approx(0.5 * mass * 1.3**2 * (1 - restitution**2), abs=1e-13)


def test_landing_against_its_differential_equation():
    """The impact in the impulse variable, with slip reversal, against scipy on the regularised law.

    Coulomb's sign(v) is smoothed to tanh(v/1e-7), which moves the result by about that much, once v has come to zero:
    until then friction is what it was, as a step across the jump would be in error by luck of its length.
    """
    rng = np.random.default_rng(7)
    reversed_or_stuck = 0
    for _ in range(30):
        hoop = Hoop(float(rng.uniform(0.05, 0.8)), 1.0, float(rng.choice([0, 0.1, 1])))
        mu, phi = float(rng.uniform(0, 0.6)), float(rng.uniform(0, 2 * pi))
        par = parameters(Scene(hoop, Friction(mu, mu), Release(1.0)))
        state = at_landing(par, phi, float(rng.normal()), float(rng.normal() * 0.3), -float(rng.uniform(0.1, 2)))
        omega, v0, un0 = state[OMEGA], state[SLIP], state[UN]
        e, gyr, s, arm = par[0], par[2], sin(phi), 1 + par[0] * cos(phi)

        def slope(_, y, way, mu=mu, s=s, e=e, arm=arm, gyr=gyr):
            f = -mu * (way or np.tanh(y[0] / 1e-7))
            return [
                f * (1 + arm**2 / gyr) - e * s * arm / gyr,
                1 + (e * s) ** 2 / gyr - f * e * s * arm / gyr,
                (e * s - f * arm) / gyr,
            ]

        def compression_over(_, y, way):
            return y[1]

        def slip_over(_, y, way):
            return y[0]

        compression_over.terminal = slip_over.terminal = True
        close = {"method": "Radau", "rtol": 1e-9, "atol": 1e-11}
        ends = (compression_over, slip_over)
        run = solve_ivp(slope, (0, 50), [v0, un0, omega], events=ends, args=(copysign(1, v0),), **close)
        if not run.t_events[0].size:
            at_rest = [0.0, *run.y[1:, -1]]
            close["first_step"] = 1e-8  # over a slope that is of the order of 1, within the layer
            run = solve_ivp(slope, (run.t[-1], 50), at_rest, events=compression_over, args=(0.0,), **close)
        strike(par, state, 0.0)
        assert state[SLIP] == pytest.approx(run.y[0, -1], abs=1e-6)
        assert state[OMEGA] == pytest.approx(run.y[2, -1], abs=1e-6 / sqrt(gyr))
        reversed_or_stuck += v0 * state[SLIP] <= 0
    assert reversed_or_stuck > 5


@pytest.mark.parametrize(("share", "sticks"), [(0.9, False), (1.1, True)])
def test_a_slip_that_stops_in_a_landing_is_held_by_the_static_coefficient(share, sticks):
    """While it sticks F/N = e s (1 + e c)/(K + (1 + e c)^2): mu_s holds that or not, mu, which is less, has no say."""
    hoop, phi = Hoop(0.3), 2.0
    arm, es = 1 + hoop.e * cos(phi), hoop.e * sin(phi)
    needed = es * arm / (hoop.K + arm**2)
    par = parameters(Scene(hoop, Friction(share * needed, 0.8 * needed), Release(1.0)))
    state = at_landing(par, phi, 0.0, 0.01, -1.0)
    strike(par, state, 0.0)
    assert (state[SLIP] == 0) == sticks
    assert state[SLIP] <= 0, "else it slips on the other way"


def test_no_landing_makes_energy():
    rng = np.random.default_rng(3)
    for _ in range(400):
        hoop = Hoop(float(10 ** rng.uniform(-4, -0.05)), float(rng.uniform(1, 2)), float(rng.choice([0, 0.01, 1])))
        mu = float(rng.uniform(0, 3))
        par = parameters(Scene(hoop, Friction(mu * float(rng.uniform(1, 3)), mu), Release(1.0)))
        phi, omega, slip, un = rng.uniform(0, 2 * pi), rng.normal(), rng.normal(), -rng.exponential()
        state = at_landing(par, float(phi), float(omega), float(slip), float(un))
        before = energy(par, state)
        strike(par, state, float(rng.uniform()))
        assert energy(par, state) <= before * (1 + 1e-12)
        assert state[UN] >= 0


def test_bouncing_comes_to_an_end():
    """Ever smaller hops accumulate in finite time; the last is taken without restitution and the motion goes on."""
    scene = Scene(Hoop(0.5), Friction(0.5, 0.4), Release(radians(300), 3.0), Run(turns=2), Landing(0.6))
    motion = simulate(scene)
    hops = [phase for phase in motion.phases if phase.kind == Kind.FLIGHT]
    assert len(hops) > 5
    assert motion.phases[-1].kind != Kind.FLIGHT
    assert "turn" in motion.ended


def test_near_jam_of_a_skid():
    """k = 0.1, mu_s = 0.7, mu = 0.6 from 10 degrees: N blows up as D -> 0+ near 294.6 degrees, then the hoop rolls.

    N there is of the order of 3e6 m g; it takes no more phases than any other motion.
    """
    motion = simulate(Scene(Hoop(0.1), Friction(0.7, 0.6), Release(radians(10)), Run(turns=1)))
    skid = next(p for p in motion.phases if p.kind == Kind.SKID and p.phi_end > radians(280))
    assert np.degrees(skid.phi_end) == pytest.approx(294.6, abs=0.1)
    following = motion.phases[motion.phases.index(skid) + 1 :]
    assert next(phase.kind for phase in following if phase.kind != Kind.IMPACT) == Kind.ROLL
    t = skid.t_end - np.geomspace(1e-12, 1e-3, 200)
    assert motion.at(t).normal_force.max() > 1e5


def test_release_in_a_jam():
    """Skidding where D < 0 there is no bounded force: an impact without collision stops the slip at once."""
    hoop, phi = Hoop(0.05), radians(300)
    s, c = sin(phi), cos(phi)
    limit = (hoop.K + (hoop.e * s) ** 2) / (-hoop.e * s * (1 + hoop.e * c))
    motion = simulate(Scene(hoop, Friction(2 * limit, 1.2 * limit), Release(phi, 0.0, 0.5), Run(turns=1)))
    assert motion.phases[0].kind == Kind.IMPACT
    assert motion.phases[0].t_end == 0
    assert motion.phases[1].kind == Kind.ROLL
    assert motion.at(0.0).slip_velocity == 0
    below = simulate(Scene(hoop, Friction(2 * limit, 0.8 * limit), Release(phi, 0.0, 0.5), Run(turns=1)))
    assert below.phases[0].kind == Kind.SKID


@pytest.mark.parametrize("k", [1e-8, 1e-7, 1e-6])
@pytest.mark.parametrize("restitution", [0.5, 0.9375])
def test_hops_of_a_tiny_hoop_make_no_energy(k, restitution):
    """phidot reaches 1/k at the floor; on a smooth one xdot_G never changes and each landing takes energy."""
    motion = simulate(Scene(Hoop(k, 2.0), Friction(0, 0), Release(0, 1.75), Run(turns=2), landing=Landing(restitution)))
    assert sum(phase.kind == Kind.FLIGHT for phase in motion.phases) > 3
    energy = motion.at(np.array([(p.t_start + p.t_end) / 2 for p in motion.phases if p.t_end > p.t_start])).energy
    assert np.diff(energy).max() < 1e-12 * energy[0]


@pytest.mark.parametrize("k", [1e-8, 1e-5])
def test_a_smooth_pass_of_a_tiny_hoop_keeps_its_energy(k):
    """Without friction every pass is its own mirror image: the same energy and, at the same height, |phidot|."""
    motion = simulate(Scene(Hoop(k, 1.5), Friction(0, 0), Release(1.0, 0.3, 0.2), Run(t_end=30.0)))
    states = motion.at(np.linspace(0, 30, 1000))
    assert np.ptp(states.energy) < 1e-12 * states.energy[0]
    xdot_g = states.slip_velocity + states.omega * (1 + motion.scene.hoop.e * np.cos(states.phi))
    assert np.ptp(xdot_g) < 1e-12 * abs(states.omega).max()


def test_a_jammed_landing_makes_no_energy():
    """D = K + e s P vanishes to round-off with K ~ 1e-17: P is then -K/(e s), not the round-off of its terms."""
    hoop, mu = Hoop(1.35e-8, 1.8935927956232002), 0.5028936512116338
    motion = simulate(
        Scene(hoop, Friction(1.2, mu), Release(2.5, -3.0, -1.0), Run(until="rest"), landing=Landing(0.13))
    )
    jams = [phase for phase in motion.phases if phase.kind == Kind.IMPACT]
    assert jams
    energy = motion.at(np.array([p.t_start for p in motion.phases])).energy
    assert np.diff(energy).max() < 1e-11 * energy[0]


def test_a_long_low_flight_over_the_top():
    """At omega = 1 the rotation all but carries the hoop over the top: gap'' is 1e-7 of its bound, the flight 1e-13
    high and 3e-3 long. It ends where the gap is 0, moving down, and the motion goes on without a loss."""
    motion = simulate(Scene(Hoop(1e-8), Friction(0, 0), Release(0, 2.5), Run(turns=2)))
    flight = next(p for p in motion.phases if p.kind == Kind.FLIGHT and p.t_start > 0)
    before = motion.at(flight.t_start)
    lift = motion.scene.hoop.e * before.omega**2 - 1  # gap'' at the top
    # constant on the way but for the fall of cos phi, phi0^2/2 = lift: gap'' = lift - phi^2/2 from -phi0, from rest
    top = sqrt(2 * lift)
    assert abs(flight.phi_start) == pytest.approx(top, rel=1e-5)
    assert abs(flight.phi_end) == pytest.approx(3 * top, rel=1e-4)  # (x + 1)^3 (3 - x) = 0 in x = phi/phi0
    energies = np.array([turn.energy for turn in motion.turns])
    # phidot reaches 1/k = 1e8 on the way, whose square carries a relative round-off of some 1e-14 into the energy
    assert len(energies) == 2
    assert np.abs(energies - motion.at(0.0).energy).max() < 1e-12 * energies[0]


def test_a_grazing_landing_is_no_jam():
    """A contact point that comes down with no speed at all where D > 0 stays as it is."""
    par = parameters(Scene(Hoop(0.1), Friction(0, 0), Release(0.3, -1.0)))
    state = [0.0] * STATE
    state[ANGLE], state[TOP], _ = chart(0.3, 1.0, 0)
    state[OMEGA], state[SLIP] = -1.0, 0.5
    assert not strike(par, state, 0.0)
    assert (state[OMEGA], state[SLIP], state[UN]) == (-1.0, 0.5, 0.0)


@pytest.mark.parametrize("units", [{}, {"R": 0.4, "m": 0.3, "g": 9.81}])
def test_a_release_aloft_goes_on_with_a_flight(units):
    """From a state in flight, its height and rise, the motion is what it was: round-off times what lands amplify."""
    hoop = Hoop(0.2, 1.1, 0.5, **units)
    unit = 1.0 if not units else sqrt(9.81 / 0.4)
    motion = simulate(Scene(hoop, Friction(0.6, 0.6), Release(radians(-20), 1.8108 * unit), Run(turns=1)))
    flight = motion.phases[0]
    assert flight.kind == Kind.FLIGHT
    t, step = flight.t_end / 3, flight.t_end * 1e-4
    now, around = motion.at(t), motion.at(t + step * np.array([-1.0, 1.0])).y_C
    release = Release(float(now.phi), float(now.omega), float(now.slip_velocity))
    # a height's second difference is g: the mean slope is the slope but for its third one, 1e-8 of a flight squared
    scene = Scene(hoop, Friction(0.6, 0.6), release, Run(turns=1))
    on = simulate(scene, (float(now.y_C) - hoop.R, float(np.diff(around)[0]) / (2 * step)))
    assert [phase.kind for phase in on.phases] == [phase.kind for phase in motion.phases]
    assert on.t_end + t == pytest.approx(motion.t_end, rel=1e-6)
    assert on.pulses[0].normal_impulse == pytest.approx(motion.pulses[0].normal_impulse, rel=1e-6)


def test_a_hoop_let_fall_takes_the_time_of_its_fall():
    """sqrt(2 h/g) from rest, and at rest it falls without turning."""
    motion = simulate(Scene(Hoop(0.1, 1.02), Friction(0.35, 0.3), Release(radians(10)), Run(turns=1)), (0.5, 0.0))
    assert motion.phases[0].kind == Kind.FLIGHT
    assert motion.phases[0].t_end == pytest.approx(1.0, rel=1e-14)
    assert motion.phases[0].phi_end == pytest.approx(radians(10), rel=1e-14)


@pytest.mark.parametrize("number", [np.float32, np.int64, np.float64, np.array])
def test_a_height_may_be_a_number_of_numpys(number):
    """As a scene's own may."""
    scene = Scene(Hoop(0.1, 1.02), Friction(0.35, 0.3), Release(radians(10)), Run(turns=1))
    assert simulate(scene, Aloft(number(1))).ended == simulate(scene, Aloft(1.0)).ended
    with pytest.raises(SceneError, match="aloft's height"):
        simulate(scene, Aloft(number(-1)))


@pytest.mark.parametrize("aloft", [(-0.1, 0.0), (0.0, -0.1), (nan, 0.0), (0.0, inf)])
def test_a_release_below_the_floor_is_refused(aloft):
    """With a sentence."""
    scene = Scene(Hoop(0.1, 1.02), Friction(0.35, 0.3), Release(radians(10)), Run(turns=1))
    with pytest.raises(SceneError, match="aloft"):
        simulate(scene, aloft)
    with pytest.raises(SceneError, match="point mass"):
        simulate(Scene(Hoop(0.0), Friction(0.35, 0.3), Release(1.0), Run(turns=1)), (0.1, 0.0))
