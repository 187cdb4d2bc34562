"""The phase machine: which phase comes next, and each phase run to its end.

``entry_run`` advances a state until its event log is full, its allowance of work is spent, or the motion is over;
it can be called again to go on. Rules where Coulomb's law leaves a choice (derived in README.md of this package; what
a contact point at rest does is in :mod:`rigid.phases.contact`):

* slipping with D > 0: contact while 1 - e c phidot^2 > 0, else flight.
* slipping towards D -> 0+ with N -> infinity, a jam: when D is round-off of its terms the configuration is frozen
  and the slip goes on to its stop, an impact without collision. It may end with 1 - e c phidot^2 < 0, and phidot
  may reverse in it: a floor that gives way a little does the same.
* slipping with D < 0 (only a release or a landing can be there): flight if 1 - e c phidot^2 <= 0 (contact
  would be consistent too), else an impact without collision.
* a rebound slower than ``SLOWEST_HOP`` sqrt(g R) is no hop: the landing is taken without restitution. So an
  accumulation of ever smaller hops ends.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import floor, inf, pi

from ..kernel.angle import PI_LOW, chart, trig
from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    A_EVENT,
    ANGLE,
    CHOOSE,
    ECC,
    FIRST_PULSE,
    FLIGHT,
    GAP,
    GYR,
    HELD,
    HOPS,
    IMPACT,
    LAST_ENERGY,
    LAST_KIND,
    LAST_TURNS,
    MODE,
    MORE,
    MU,
    OMEGA,
    P_OPEN,
    P_PEAK,
    PHASE_OVER,
    PULSE_OVER,
    RECORDS,
    REST,
    RESTITUTION,
    ROLL,
    SETTLES,
    SKID,
    SKIM,
    SLIDES,
    SLIDES_DONE,
    SLIP,
    SPIN,
    STALLS,
    STEPS,
    T_END,
    T_FROM,
    TIME_REACHED,
    TOP,
    TURNS_DONE,
    TURNS_REACHED,
    UN,
    UNTIL,
    WHOLE,
    WIDTH,
    WORK_BOUND,
    XDOT,
    YDOT,
    T,
)
from ..record.cycle import NEVER
from ..record.events import ROOM, begin, turn
from ..record.pulse import energy, released, watch
from .contact import contact_kind, slip_kind
from .flight import fly, settle, touch_down
from .impact import strike
from .pointmass import catch, choose_point_mass, roll_point_mass
from .rolling.phase import roll
from .skimming import skim
from .slipping.phase import slide

# phi0 this close to a multiple of pi, relatively, means that multiple: no float but 0 is one itself
LEVEL = 2.3e-16
NOTHING_AT_ALL = 1e-140  # an angle or a velocity whose square would underflow
SLOWEST_HOP = 1e-6
MOST_STALLS = 50.0
SLIPS, LEAST_LOSS = 100.0, 1e-4


@kernel
def release_from(state, phi0, omega0, slip0):
    """The state at t = 0; 0 for what is no more than the round-off of its unit."""
    for i in range(len(state)):
        state[i] = 0.0
    turns = float(floor(phi0 / (2 * pi) + 0.5))
    a, top, whole = chart((phi0 - turns * (2 * pi)) - turns * (2 * PI_LOW), 1.0, turns)
    if a != phi0 and abs(a) <= LEVEL * max(1.0, abs(phi0)):
        a = 0.0
    state[ANGLE], state[TOP], state[WHOLE], state[OMEGA], state[SLIP] = a, top, whole, omega0, slip0
    for i in (ANGLE, OMEGA, SLIP):
        if abs(state[i]) < NOTHING_AT_ALL:
            state[i] = 0.0


@kernel
def enter(par, state, kind, events):
    """Go on with a kind; a jam is an impact yet to come."""
    if kind == IMPACT:
        state[MODE] = IMPACT
    else:
        begin(par, state, kind, events)


@kernel
def choose(par, state, events):
    """What the contact does from here on."""
    if state[LAST_KIND] == CHOOSE:
        released(par, state)
    if not (state[GAP] > 0.0 or state[UN] > 0.0):
        state[GAP] = 0.0
        state[UN] = 0.0
        if par[GYR] == 0.0:
            choose_point_mass(par, state, events)
            return
    enter(par, state, contact_kind(par, state), events)


@kernel
def soar(par, state, events):
    """Fly to the next touch-down and strike the floor."""
    state[A_EVENT] = NEVER  # whatever came round does so no more
    if watch(par, state, 0.0, events) and par[UNTIL] == FIRST_PULSE:
        return PULSE_OVER
    time = touch_down(par[ECC], state[GAP], state[UN], state[OMEGA], state[ANGLE], state[TOP])
    if state[T] + time >= par[T_END]:
        fly(par, state, par[T_END] - state[T])
        state[T] = par[T_END]
        return TIME_REACHED
    s, _, _, _ = trig(state[ANGLE], state[TOP])
    a, top = state[ANGLE], state[TOP]
    rise = state[GAP] + time * (state[UN] - par[ECC] * s * state[OMEGA] - 0.5 * time)
    fly(par, state, time)
    settle(par, state, a, top, rise)
    state[GAP] = 0.0
    state[UN] = min(state[UN], 0.0)
    state[HOPS] += 1.0
    return PHASE_OVER


@kernel
def hit(par, state, events):
    """An impact, and what follows it: a hop or contact."""
    begin(par, state, IMPACT, events)
    if state[P_OPEN] != 0.0:
        # a jam, as a flight ends a pulse: no number bounds N, and the last D > 0 before it is round-off
        state[P_PEAK] = inf
    if par[GYR] == 0.0:
        return TURNS_REACHED if catch(state) and turn(par, state, events) else PHASE_OVER
    omega, slip, un, xdot, ydot = state[OMEGA], state[SLIP], state[UN], state[XDOT], state[YDOT]
    reverses = strike(par, state, par[RESTITUTION])
    if state[UN] <= SLOWEST_HOP:
        state[OMEGA], state[SLIP], state[UN], state[XDOT], state[YDOT] = omega, slip, un, xdot, ydot
        reverses = strike(par, state, 0.0)
        state[UN] = 0.0
    if reverses and turn(par, state, events):
        return TURNS_REACHED
    return PHASE_OVER


@kernel
def settles(par, state):
    """Whether the last ``SLIPS`` slips, and what came between, have taken next to nothing and brought the end of the
    run no closer.

    A motion whose slips shrink towards a rolling that just never slips does so algebraically, and would not
    end; nor would one that hops ever less, or slips over a floor with next to no friction.
    """
    if par[UNTIL] == FIRST_PULSE or par[T_END] < inf:
        return False
    state[SLIDES_DONE] += 1.0
    if state[SLIDES_DONE] < SLIPS:
        return False
    now = energy(par, state)
    idle = par[UNTIL] == REST or state[TURNS_DONE] == state[LAST_TURNS]
    done = idle and state[LAST_ENERGY] > 0.0 and state[LAST_ENERGY] - now <= LEAST_LOSS * now
    state[SLIDES_DONE], state[LAST_ENERGY], state[LAST_TURNS] = 0.0, now, state[TURNS_DONE]
    return done


@kernel
def entry_start(par, release, state, room, events):
    """Run from a release (phi0, omega0, slip0, height and rise of the lowest point, allowance of steps)."""
    release_from(state, release[0], release[1], release[2])
    state[GAP], state[UN], state[STEPS] = release[3], release[4], release[5]
    return entry_run(par, state, room, events)


@kernel
def entry_run(par, state, room, events):
    """Run until the event log is full (MORE), the allowance of steps is spent (WORK_BOUND) or the motion is
    over.
    """
    work, rows = room
    while True:
        held = state[HELD] != 0.0  # by slide, which looks itself whether there is room and work left
        if not held and state[RECORDS] * WIDTH + ROOM * WIDTH > len(events):
            return MORE
        if not held and state[STEPS] <= 0.0:
            return WORK_BOUND
        state[STEPS] -= 0.0 if held else 1.0
        mode = state[MODE]
        code = PHASE_OVER
        before, angle, omega = state[T_FROM] if held else state[T], state[ANGLE], state[OMEGA]
        if mode == CHOOSE:
            choose(par, state, events)
            continue
        if mode == ROLL:
            if par[GYR] == 0.0:
                code = roll_point_mass(par, state, events, par[T_END])
            else:
                code = roll(par, state, work, events)
                if code == PHASE_OVER:
                    enter(par, state, slip_kind(par, state), events)
        elif mode in (SKID, SPIN):
            if not held and settles(par, state):
                # on a smooth floor too, of a hoop that hops: its landings take energy
                return SETTLES if par[MU] > 0.0 or state[HOPS] > 0.0 else SLIDES
            code = slide(par, state, work, rows, events)
            if state[MODE] == FLIGHT:
                begin(par, state, FLIGHT, events)
        elif mode == FLIGHT:
            code = soar(par, state, events)
            if code == PHASE_OVER:
                state[MODE] = IMPACT
                state[STALLS] = 0.0 if state[T] != before else state[STALLS]
                continue
        elif mode == IMPACT:
            code = hit(par, state, events)
        elif mode == SKIM:
            code = skim(par, state, events)
        if code != PHASE_OVER:
            return code
        # a phase of a tiny disk may be shorter than t resolves: one that moved counts less than one that did not
        moved = state[ANGLE] != angle or state[OMEGA] != omega
        state[STALLS] = 0.0 if state[T] != before else state[STALLS] + (0.02 if moved else 1.0)
        if state[STALLS] > MOST_STALLS:
            return WORK_BOUND
        if state[MODE] == mode:
            state[MODE] = CHOOSE
