"""Steps that end at an event, or cannot be solved: events are located, failures are told, contact opens and closes."""

import itertools
from math import pi

import numpy as np
import pytest
from scenes import HOOP, flying

import flexible
import flexible.time.advance
import flexible.time.control
import rigid
from flexible.contact.laws.patch import SLIDE_RIGHT, STICK
from flexible.contact.vectors import largest
from flexible.models.full import FullHoop
from flexible.models.reduced import ReducedHoop
from flexible.start.equilibrium import equilibrium
from flexible.start.handover import hand_over
from flexible.start.pose import Pose
from flexible.time.adaptive import Limits, MarchError, attempt, march, restart
from flexible.time.events import HIGH_END, MODE_ENDS, Ends, chosen, is_lost, is_open, search_of, told, unsolved
from rigid import Contact, Friction, Hoop, Kind, Release, Ring, Run, Scene, Solve

#: slips out of rolling a moment after its release
SLIPPING = HOOP.replace(release={"phi0": 1.5, "omega0": 1.0}, hoop={"mass_ratio": 0.0}, friction={"mu_s": 0.35})


def start_of(scene, model=ReducedHoop):
    return model(scene), hand_over(model(scene), rigid.simulate(scene), 0.0)


def in_python(scene):
    """The start of a hoop whose steps Python takes, so that a test can have some fail."""
    return start_of(scene.replace(solve={"elements": 60}), FullHoop)


def numbered(root, unsolved=(2.0, 3.0)):
    """Steps that are their own length and are past ``root``; lengths inside ``unsolved`` cannot be solved."""
    tried = []

    def step(h):
        tried.append(h)
        return None if unsolved[0] < h < unsolved[1] else h

    return step, (lambda h: (h - root) / 1e-9), tried


def located(step, past, event=MODE_ENDS):
    """The end of the search in a step of length 1, None if there is none, and whether it is at the event."""
    search = search_of(event, 1.0, past(0.0), past(1.0))
    while is_open(search):
        found = step(search.length)
        search = unsolved(search) if found is None else told(search, past(found))
    return chosen(search) or None, not is_lost(search)


@pytest.mark.parametrize("root", [1e-7, 0.2, 0.5, 0.999])
def test_an_event_is_located_around_lengths_that_cannot_be_solved(root):
    """A third of the bracket fails, the event outside it is found to its tolerance all the same."""
    step, past, tried = numbered(root, (0.21, 0.49))
    found, at_event = located(step, past)
    assert at_event
    assert 0 <= past(found) <= 1
    assert len(tried) < 60  # bisection alone takes 30 from 1 to 1e-9, and six lengths at most are tried for each


def test_an_event_among_lengths_that_cannot_be_solved_is_not_taken_for_located():
    """The step then ends before it; where no length can be solved there is no step."""
    step, past, _ = numbered(0.3, (0.21, 0.49))
    found, at_event = located(step, past)
    assert not at_event
    assert found <= 0.21
    step, past, _ = numbered(0.3, (0.0, 1.0))
    assert located(step, past)[0] is None


@pytest.mark.parametrize("event", [MODE_ENDS, HIGH_END])
def test_a_jump_is_located_in_time(event):
    """A function without a zero, -1 before 0.3 and 1e12 after: the bracket tells, to its share 1e-10 of the step.

    A mode of the patch ends before it is past its bound, a march when it is past its end.
    """
    found, at_event = located(lambda h: h, lambda h: 1e12 if h > 0.3 else -1.0, event)
    assert at_event
    assert 0 < (0.3 - found if event == MODE_ENDS else found - 0.3) < 1e-10


@pytest.mark.parametrize("failing", [0.5, 1.0])
def test_no_step_passes_its_event_where_shorter_ones_fail(failing, monkeypatch):
    """Whenever the end of a sticking is to be located, some or all shorter steps fail: |F| <= mu_s N stays true."""
    hoop, start = in_python(SLIPPING)
    mu_s = SLIPPING.friction.mu_s

    def fails(model, old, h, *of):
        trial = tried(model, old, h, *of)
        if h > 0 and trial.ok and old.mode == STICK and abs(trial.res.friction) > mu_s * trial.res.normal:
            fails.longest = h, old.t
        known = fails.longest is not None and fails.longest[1] == old.t
        fails_here = known and (1 - failing) * fails.longest[0] < h < fails.longest[0]
        return trial._replace(ok=False) if fails_here else trial

    fails.longest, tried = None, flexible.time.advance.tried
    monkeypatch.setattr(flexible.time.advance, "tried", fails)
    _, records, _, ended, _ = march(hoop, start, Ends(t=0.5), 1e-3, Limits(most=400))
    assert fails.longest is not None  # it did come to an end
    assert records[-1].t <= 0.5 + 1e-12
    for record in records:
        if record.mode == STICK:  # Newton's tolerance of 1e-9 (1 + N) on both forces
            assert abs(record.friction_force) <= mu_s * record.normal_force + 3e-9 * (1 + record.normal_force)
    if failing == 1:  # nothing leads up to the event, and nothing is taken beyond it
        assert "no step however short" in ended.why
        assert records[-1].t == fails.longest[1]
    else:  # lengths up to half of that which passed the event can be solved: it breaks loose within them and slides on
        assert not ended
        assert records[-1].t == pytest.approx(0.5, abs=1e-12)
        assert records[-1].mode != STICK


def test_a_step_that_could_be_solved_is_not_the_last_one(monkeypatch):
    """At one instant nothing longer than 5e-13 can be: behind it steps grow again.

    What they learnt from the one before, a hundred million times as long, was to be shorter still.
    """
    hoop, start = in_python(SLIPPING)
    stuck: list[float] = []

    def fails(model, old, h, *of):
        if old.t > 0.05 and not stuck:
            stuck.append(old.t)
        return tried(model, old, h, *of)._replace(**({"ok": False} if h > 5e-13 and old.t in stuck else {}))

    tried = flexible.time.advance.tried
    monkeypatch.setattr(flexible.time.advance, "tried", fails)
    _, records, _, ended, _ = march(hoop, start, Ends(t=0.2), 1e-3, Limits(most=400))
    assert stuck
    assert not ended, ended
    assert records[-1].t == pytest.approx(0.2)


def test_a_turn_inside_a_leap_is_counted(monkeypatch):
    """Nowhere with |phidot| < 1e-6 can a step be solved: it is leapt over, and the turn is there."""
    scene = HOOP.replace(
        release={"phi0": 1.0, "omega0": -0.01}, hoop={"mass_ratio": 0.0}, friction={"mu_s": 2, "mu": 2}
    )
    hoop, start = in_python(scene)

    def fails(model, old, h, *of):
        trial = tried(model, old, h, *of)
        return trial._replace(**({"ok": False} if abs(trial.vel[2]) < 1e-6 else {}))

    tried = flexible.time.advance.tried
    monkeypatch.setattr(flexible.time.advance, "tried", fails)
    _, records, _, ended, _ = march(hoop, start, Ends(t=1.0, turns=1), 1e-3, Limits(most=400))
    assert not ended, ended
    before, behind = records[-2:]
    assert before.omega < 0 < behind.omega
    assert behind.t - before.t <= flexible.time.control.FARTHEST


def test_a_number_that_is_none_is_not_passed_over():
    assert largest(np.array([1.0, -2.0])) == 2.0
    for bad in (np.nan, np.inf):
        for place in range(3):
            values = np.array([1.0, 2.0, 3.0])
            values[place] = bad
            assert largest(values) == np.inf


@pytest.mark.parametrize("model", [ReducedHoop, FullHoop])
@pytest.mark.parametrize("place", [0, 1, 2, 5])
def test_a_state_that_is_no_number_is_a_failed_step(model, place):
    """In any coordinate, rates and accelerations too, whichever comparison it meets first."""
    hoop, start = start_of(HOOP.replace(release={"phi0": 1.5, "omega0": 1.0}), model)
    assert attempt(hoop, start, 1e-5) is not None
    for name in ("vel", "acc"):
        field = getattr(start, name).copy()
        field[place] = np.nan
        broken = start._replace(**{name: field})
        assert attempt(hoop, broken, 1e-5) is None
    pos = start.pos.copy()
    pos[place] = np.nan
    broken = start._replace(pos=pos)
    with pytest.raises(MarchError):
        restart(hoop, broken, STICK)


def test_a_singular_ring_is_a_failed_step_and_no_start(monkeypatch):
    """scipy's sparse factors say RuntimeError: a stage that cannot be solved, and an equilibrium that is not there."""
    scene = HOOP.replace(release={"phi0": 1.5, "omega0": 1.0}, hoop={"mass_ratio": 0.0})
    hoop, start = start_of(scene, FullHoop)
    nothing = hoop.ring.tangent(start.pos[3:]) * 0
    monkeypatch.setattr(hoop.ring, "tangent", lambda u: nothing)
    hoop._factored = None
    assert attempt(hoop, start, 1e-5) is None
    with pytest.raises(MarchError, match="no equilibrium"):
        equilibrium(hoop, Pose(pi, 0.0, 0.0, 1.0, 0.1, Kind.ROLL))


def opening(bending, foundation, mu_s=0.538, rtol=1e-3):
    """An undamped patch that spins, opens and closes in the pulse of a small disk."""
    return Scene(
        Hoop(k=0.0515, r=1.158, mass_ratio=0.0), Friction(mu_s, 0.38), Release(26 * pi / 180), Run(until="pulse"),
        ring=Ring(bending_stiffness=bending), contact=Contact(stiffness=foundation, damping=0.0),
        solve=Solve(rtol=rtol),
    )  # fmt: skip


@pytest.mark.parametrize("mode", [STICK, SLIDE_RIGHT])
def test_a_restart_moves_nothing(mode):
    """A patch 1e-12 deep, as one that just opens: the law of friction changes, N does not.

    A stage of 1e-7 moves the hoop by its acceleration times 1e-14, here half of that depth.
    """
    scene = opening(1e7, 1e12)
    hoop = ReducedHoop(scene)
    spacing = hoop.law.parameters.spacing
    lowest = round((pi - 3.0916) / spacing)  # the point at the bottom, which alone is in so thin a patch
    pos, vel = np.array([0.0, -1e-12, pi - lowest * spacing]), np.array([0.0, -1e-3, 6.9])
    state = restart(hoop, flying(hoop, pos, vel), mode)
    again = restart(hoop, state, mode)
    assert abs(state.acc[1]) > 10
    assert 0 < state.res.normal < 1e-3
    slack = 1e-9 * 1e-3  # Newton's tolerance, of displacements that are forces over the patch's own stiffness
    assert again.res.normal == pytest.approx(state.res.normal, rel=1e-6, abs=slack)


@pytest.mark.parametrize(
    ("bending", "foundation", "rtol"),
    [(1e7, 1e12, 3e-4), (1e7, 1e13, 3e-3), (1e8, 1e12, 3e-3), (1e8, 1e13, 1e-3), (1e9, 1e13, 1e-3), (1e10, 1e14, 3e-3)],
)
@pytest.mark.slow
def test_a_patch_that_opens_and_closes_is_integrated_through(bending, foundation, rtol):
    """Each of them ended on the way. An undamped patch rings, and breaks its stick early by a scatter: as if its static
    coefficient lay between the kinetic and its own."""
    scene = opening(bending, foundation, rtol=rtol)
    motion = flexible.simulate(scene)
    assert motion.completed, motion.ended
    assert motion.pulses[0].time_off_floor > 0  # it does open
    latest, earliest = (
        rigid.simulate(scene.replace(friction={"mu_s": mu_s})).pulses[0].impulse_ratio for mu_s in (0.538, 0.38)
    )
    assert latest - 1e-3 < motion.pulses[0].impulse_ratio < earliest  # 1e-3: what the foundation of 1e12 is still off


def test_one_coefficient_of_friction_does_not_stick_and_slip_without_end():
    """mu_s = mu, undamped: where N falls faster than the bristles let go the patch slides on; the brush agrees.

    Their rigid limit is the same hoop. 1e-3 of J_N: some patch widths, (1.5 N/eps)^(1/3) = 5e-4 at N = 100; rtol is a
    tenth of that.
    """
    scene = opening(1e10, 1e12, mu_s=0.38).replace(solve={"rtol": 1e-4})
    patch, brush = (flexible.simulate(scene.replace(contact={"law": law})) for law in ("patch", "brush"))
    assert patch.completed, patch.ended
    exact = rigid.simulate(scene).pulses[0]
    for motion in (patch, brush):
        pulse = motion.pulses[0]
        assert pulse.friction_impulse == pytest.approx(exact.friction_impulse, abs=1e-3 * exact.normal_impulse)


def test_order_across_the_start_of_slip():
    """Equal steps over a stick that breaks: its event is located, so the end keeps the order 3 of the integrator.

    A soft floor and two modes, as for the order without events; the time of the event is of that order too. At 0.077 it
    leaves the floor, and by 0.07 the error of phi, which is the other way than what that of omega adds, is none.
    """
    scene = HOOP.replace(
        hoop={"mass_ratio": 0.0}, release={"phi0": 1.5, "omega0": 1.0}, contact={"stiffness": 1e4},
        friction={"mu_s": 0.81, "mu": 0.6},  # F/N is .795 at first and grows
    )  # fmt: skip
    hoop = ReducedHoop(scene, modes=2)
    start = hand_over(hoop, rigid.simulate(scene.replace(friction={"mu_s": 9.0, "mu": 9.0})), 0.0)
    steps = 0.1 / np.array([50, 100, 200, 1600])
    ends = []
    for step in steps:
        last, records, _, ended, _ = march(hoop, start, Ends(t=0.04), 0.5, Limits(step, step))
        assert not ended
        breaks = [b.t for a, b in itertools.pairwise(records) if a.mode == STICK != b.mode]
        assert breaks
        ends.append([breaks[0], last.pos[2], last.vel[2], records[-1].friction_impulse])
    errors = np.abs(np.array(ends[:-1]) - ends[-1])
    for column in errors.T:
        slope = np.polyfit(np.log(steps[:-1]), np.log(column), 1)[0]
        assert slope == pytest.approx(3, abs=0.4)  # three halvings; the last is an eighth of the finest
