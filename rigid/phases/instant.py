"""Any instant of a motion on demand: the phases are evaluated again, from their starting states."""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import inf

from ..kernel.angle import angle_of, trig
from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    ANGLE,
    END,
    FLIGHT,
    GAP,
    GYR,
    IMPACT,
    MOVING,
    MU,
    OMEGA,
    ORDER,
    PHASE_FROM_TOP,
    PHASE_TOP_SIZE,
    PULL,
    ROLL,
    S_D,
    S_P,
    S_T,
    SKID,
    SKIM,
    SLIP,
    SLIP_SCALE,
    SPIN,
    T_FROM,
    T_SINCE,
    TOP,
    WHOLE,
    WIDTH,
    X_C,
    XDOT,
    ZETA,
    T,
)
from ..kernel.polynomial import polish, value
from ..record.pulse import energy
from .contact import contact_kind
from .flight import fly
from .pointmass import point_mass_kind, roll_point_mass_on
from .rolling.closed_form import rolling_acceleration, rolling_forces
from .rolling.phase import roll_on
from .skimming import drop, skimming_acceleration
from .slipping.series import JAM, normal_force, slipping_acceleration
from .slipping.step import (  # fmt: skip
    GRAZES,
    NOTHING_YET,
    STOPS,
    carry,
    carry_steadily,
    end_of_slip,
    is_steady,
    keep_energy,
    step,
)

MOST_STEPS = 400_000  # in one phase: beyond the work bound of the motion itself
LAST_DIGITS = 4e-16  # of a time
TOUCHES = 1e-6  # of a phase is left at least where the slip that stops is not its end
COLUMNS = 9  # phi, omega, x_C, height of the contact point, slip velocity, N, F, energy, phiddot


@kernel
def write_state(par, state, normal, friction, alpha, out, i):
    """One row of ``out``."""
    j = i * COLUMNS
    out[j] = angle_of(state[ANGLE], state[TOP], state[WHOLE])
    out[j + 1], out[j + 2], out[j + 3] = state[OMEGA], state[X_C], state[GAP]
    out[j + 4], out[j + 5], out[j + 6], out[j + 7] = state[SLIP], normal, friction, energy(par, state)
    out[j + 8] = alpha


@kernel
def forces(par, state, kind):
    """N, F and phiddot in a phase of this kind."""
    angle, top, omega = state[ANGLE], state[TOP], state[OMEGA]
    if kind == ROLL and par[GYR] > 0.0:
        normal, friction = rolling_forces(par, omega, angle, top)
        return normal, friction, rolling_acceleration(par[ZETA], omega, angle, top)
    if kind == ROLL:
        s, _, h, _ = trig(angle, top)
        w = omega * omega
        return h - 0.5 * (h + w * h), s * (1 - 0.5 * (1 + w)), rolling_acceleration(0.0, omega, angle, top)
    if kind in (SKID, SPIN):
        mu_hat = par[MU] if kind == SKID else -par[MU]
        # a tiny disk may lift off between two instants that the clock can tell: a contact never pulls
        normal = max(0.0, normal_force(par, mu_hat, omega, angle, top))
        return normal, -mu_hat * normal, slipping_acceleration(par, mu_hat, normal, angle, top)
    return 0.0, 0.0, skimming_acceleration(omega, angle, top) if kind == SKIM else 0.0


@kernel
def sample_slip(par, phases, owner, times, i, out, work, state):
    """Rows of ``out`` from the ``i``-th on for the times in one slip, from whose beginning ``state`` is; the next i."""
    p, start = owner[i], state[T]
    kind = phases[p * WIDTH]
    mu_hat = par[MU] if kind == SKID else -par[MU]
    p_known = inf
    steps = 0
    state[SLIP_SCALE] = 0.0
    state[T_FROM], state[T_SINCE] = start, 0.0
    from_top, size = phases[p * WIDTH + PHASE_FROM_TOP], phases[p * WIDTH + PHASE_TOP_SIZE]
    while i < len(times) and owner[i] == p:
        keep_energy(par, state, from_top, size)
        whole = step(par, state, mu_hat, p_known, work)
        length, event = end_of_slip(par, state, work, whole, 1.0 if kind == SKID else -1.0)
        tt = work[S_T]
        left = phases[(p + 1) * WIDTH + 1 + T] - start - state[T_SINCE] - value(tt, ORDER, length)
        ends = left <= TOUCHES * (phases[(p + 1) * WIDTH + 1 + T] - start)
        if event == GRAZES or (event == STOPS and not ends):
            # it comes to 0 and goes on as before, as it does on a smooth floor in every period: no end
            length, event = whole, NOTHING_YET
        duration = value(tt, ORDER, length)
        before = state[T_SINCE]
        steps += 1
        if event != NOTHING_YET and before + duration < times[i] - start:
            # the last digits of the phase: near a jam the slip stops within them
            carry(par, state, mu_hat, work, length)
            duration = inf
        elif work[S_D][0] <= JAM * par[GYR] or steps > MOST_STEPS:
            duration = inf  # jammed: nothing moves in what is left of the phase
        keep = (state[ANGLE], state[TOP], state[WHOLE], state[OMEGA], state[SLIP], state[X_C], state[XDOT])
        while i < len(times) and owner[i] == p and times[i] - start <= before + duration:
            x = 0.0
            if times[i] - start > before and duration < inf:
                tt[0] = before - (times[i] - start)
                # at the end of the step its time may be round-off short of what is asked for
                x = polish(tt, ORDER, 0.0, length) if value(tt, ORDER, length) > 0.0 else length
                tt[0] = 0.0
                carry(par, state, mu_hat, work, x)
            normal, friction, alpha = forces(par, state, kind)
            write_state(par, state, normal, friction, alpha, out, i)
            state[T_SINCE] = before
            state[ANGLE], state[TOP], state[WHOLE], state[OMEGA], state[SLIP], state[X_C], state[XDOT] = keep
            i += 1
        p_known = value(work[S_P], ORDER, length)
        carry(par, state, mu_hat, work, length)
    return i


@kernel
def sample_behind_the_blow(par, phases, owner, i, out, state):
    """Rows of ``out`` from the ``i``-th on for the impact with which a motion ends: what would have come next; the next
    i.
    """
    p = owner[i]
    for j in range(MOVING):
        state[j] = phases[(p + 1) * WIDTH + 1 + j]
    state[PULL] = 0.0
    kind = contact_kind(par, state) if par[GYR] > 0.0 else point_mass_kind(par, state)
    normal, friction, alpha = forces(par, state, kind)
    while i < len(owner) and owner[i] == p:
        write_state(par, state, normal, friction, alpha, out, i)
        i += 1
    return i


@kernel
def entry_sample(par, phases, owner, times, out, work, state):
    """Rows of ``out`` for increasing ``times``; ``phases`` are records of the event log, of which ``owner`` says by
    number which one each time belongs to.
    """
    i = 0
    while i < len(times):
        p = owner[i]
        kind = phases[p * WIDTH]
        if kind == IMPACT and phases[(p + 1) * WIDTH] == END:
            i = sample_behind_the_blow(par, phases, owner, i, out, state)
            continue
        for j in range(MOVING):
            state[j] = phases[p * WIDTH + 1 + j]
        start = state[T]
        if kind in (SKID, SPIN) and not is_steady(par, state):
            i = sample_slip(par, phases, owner, times, i, out, work, state)
            continue
        while i < len(times) and owner[i] == p:
            for j in range(MOVING):
                state[j] = phases[p * WIDTH + 1 + j]
            time = times[i] - start
            if kind in (SKID, SPIN):
                carry_steadily(state, time)
            elif kind == ROLL and par[GYR] > 0.0:
                behind = (p + 1) * WIDTH + 1
                if times[i] >= phases[behind + T] * (1 - LAST_DIGITS):
                    # its end, which may lie in a pulse narrower than what is rolled in the last digit of a late time
                    for j in range(MOVING):
                        state[j] = phases[behind + j]
                else:
                    roll_on(par, state, time)
            elif kind == ROLL:
                roll_point_mass_on(state, time)
            elif kind == FLIGHT:
                fly(par, state, time)
            elif kind == SKIM:
                drop(state, time)
            # a slip that is steady has the weight of the hoop on the floor, and nothing turns it
            normal, friction, alpha = (1.0, 0.0, 0.0) if kind in (SKID, SPIN) else forces(par, state, kind)
            write_state(par, state, normal, friction, alpha, out, i)
            i += 1
