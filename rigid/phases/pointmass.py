"""The point mass on a massless hoop (k = 0, m_h = 0, r = 1), in closed form.

Rolling, sin(phi/2) obeys S'' = S/4, so from rest sin(phi/2) = sin(phi0/2) cosh(t/2), with
N = 2 cos^2(phi/2) - G/2 and F/N = tan(phi/2), G as in :mod:`rigid.phases.rolling.closed_form`. Where
mu_s cannot hold that, the hoop skims: the mass falls freely, N = F = 0, until it hits the floor, where the motion ends.

A hoop without inertia bears no force but one through the mass, along the line from the contact point, F/N =
tan(phi/2). So it skims too while it slips, as the limit of small disks has it, but where their D < 0: there the contact
point slips away from the mass, tan(phi/2) < mu, and the floor catches the hoop at once. The blow takes the velocity
v sin(phi/2) that the mass has along the line, and phidot grows by v/2. Where the slip of a skimming hoop comes to 0 it
rolls if mu_s holds that.
"""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import asin, exp, inf, log, sqrt

from ..kernel.angle import trig
from ..kernel.compile import kernel
from ..kernel.layout import (  # fmt: skip
    ANGLE,
    CREEPS,
    FIRST_PULSE,
    IMPACT,
    MODE,
    MU,
    MU_S,
    OMEGA,
    PERIOD,
    PHASE_OVER,
    PULSE_OVER,
    RESTS,
    ROLL,
    SKID,
    SKIM,
    SLIP,
    SPIN,
    TIME_REACHED,
    TOP,
    TURNS_REACHED,
    UNTIL,
    WHOLE,
    X_C,
    T,
)
from ..record.events import begin, turn
from ..record.pulse import watch
from .rolling.closed_form import TIE


@kernel
def choose_point_mass(par, state, events):
    """A point mass on a massless hoop rolls while |tan(phi/2)| <= mu_s and N >= 0, else the hoop skims, N =
    F = 0.
    """
    s, _, h, _low = trig(state[ANGLE], state[TOP])
    if s == 0.0 and h > 0.0 and state[SLIP] != 0.0:
        if par[MU] == 0.0 and state[OMEGA] == 0.0:
            begin(par, state, SKID if state[SLIP] > 0.0 else SPIN, events)  # nothing acts on it
            return
        if is_caught_upright(par, state[OMEGA], state[SLIP]):
            catch(state)  # without a blow
    if state[SLIP] * s < 0.0 and abs(s) < par[MU] * h:
        state[MODE] = IMPACT
    else:
        begin(par, state, point_mass_kind(par, state), events)


@kernel
def point_mass_kind(par, state):
    """What a hoop does that friction has not to catch first."""
    s, _, h, _ = trig(state[ANGLE], state[TOP])
    return ROLL if state[SLIP] == 0.0 and holds(par, s, h, state[OMEGA]) else SKIM


@kernel
def is_caught_upright(par, omega, slip):
    """Whether the slip of a hoop with the mass right on top ends there: by friction, or at rest for a moment and held
    so, while phidot goes at once to 1, that of a free fall. Faster than that the hoop lifts off.
    """
    if omega * omega > 1.0:
        return False
    return par[MU] > 0.0 or (par[MU_S] > 0.0 and slip * omega > 0.0 and abs(omega + 0.5 * slip) < 1.0)


@kernel
def holds(par, s, h, omega):
    """Whether a hoop without slip rolls."""
    g = h + omega * omega * h
    return h > 0.0 and h >= 0.5 * g * (1 - TIE) and abs(s) <= par[MU_S] * h * (1 + TIE)


@kernel
def catch(state):
    """End the slip at once; whether phidot changes its sign."""
    before = state[OMEGA]
    state[OMEGA] += 0.5 * state[SLIP]
    state[SLIP] = 0.0
    return before * state[OMEGA] < 0.0


@kernel
def set_from_top(state, sine, right_of_top, cosine2):
    """Set the angle from sin(phi/2) and cos^2(phi/2), phi within pi of the top number ``right_of_top``."""
    sign = 1.0 if sine >= 0 else -1.0
    if cosine2 <= 0.5:
        offset = 2 * asin(sqrt(max(cosine2, 0.0)))
        state[ANGLE], state[TOP] = -sign * offset, 0.0
        state[WHOLE] = right_of_top if sign > 0 else right_of_top - 1.0
    else:
        state[ANGLE], state[TOP], state[WHOLE] = 2 * asin(max(-1.0, min(1.0, sine))), 1.0, right_of_top


@kernel
def growing_and_fading(state):
    """sin(phi/2) = grow e^(t/2) + fade e^(-t/2) from this state on, phi from the nearest top; the number of that."""
    _s, _, h, low = trig(state[ANGLE], state[TOP])
    top_number = state[WHOLE]
    positive = state[ANGLE] >= 0
    if state[TOP] == 0.0:
        positive = state[ANGLE] <= 0
        if not positive:
            top_number += 1.0
    sine = sqrt(0.5 * low) if positive else -sqrt(0.5 * low)
    rate = 0.5 * sqrt(0.5 * h) * state[OMEGA]
    return 0.5 * sine + rate, 0.5 * sine - rate, top_number


@kernel
def roll_point_mass_on(state, time):
    """Advance a rolling point mass, whatever happens on the way."""
    grow, fade, top_number = growing_and_fading(state)
    up, down = grow * exp(0.5 * time), fade * exp(-0.5 * time)
    sine = max(-1.0, min(1.0, up + down))
    cosine2 = 1 - sine * sine
    state[X_C] += 2 * (asin(sine) - asin(max(-1.0, min(1.0, grow + fade))))
    set_from_top(state, sine, top_number, cosine2)
    state[OMEGA] = (up - down) / sqrt(cosine2) if cosine2 > 0.0 else 0.0
    state[T] += time


@kernel
def roll_point_mass(par, state, events, t_end):
    """Roll to the turn, to where the hoop begins to skim, or to the time ``t_end``."""
    if watch(par, state, 0.0, events) and par[UNTIL] == FIRST_PULSE:
        return PULSE_OVER
    _s, _, h, _ = trig(state[ANGLE], state[TOP])
    g = h + state[OMEGA] * state[OMEGA] * h
    grow, fade, top_number = growing_and_fading(state)
    sine = grow + fade
    x_start = state[X_C] - 2 * asin(max(-1.0, min(1.0, sine)))
    time, limit, turn_at = inf, 0.0, inf
    if grow != 0.0:
        # N >= 0 is cos^2 >= G/4; |F| <= mu_s N is |tan| <= mu_s
        mu_s = par[MU_S]
        limit = sqrt(min(mu_s * mu_s / (1 + mu_s * mu_s), max(0.0, 1 - 0.25 * g)))
        if (grow - fade) * grow >= 0:
            limit = max(limit, sine if grow > 0 else -sine)
        time = max(0.0, 2 * log((limit + sqrt(max(0.0, limit * limit - 4 * grow * fade))) / (2 * abs(grow))))
        if fade * grow > 0 and abs(fade) > abs(grow):
            turn_at = log(fade / grow)
    reason = PHASE_OVER
    end = min(time, turn_at)
    if state[T] + end >= t_end:
        end, reason = max(0.0, t_end - state[T]), TIME_REACHED
    if end == inf:
        state[PERIOD] = inf
        return RESTS if fade == 0.0 else CREEPS
    up, down = grow * exp(0.5 * end), fade * exp(-0.5 * end)
    sine = up + down
    if reason == PHASE_OVER and time <= turn_at:
        sine = limit if grow > 0 else -limit
    cosine2 = 1 - sine * sine
    set_from_top(state, sine, top_number, cosine2)
    state[T] = t_end if reason == TIME_REACHED else state[T] + end
    speed = sqrt(max(0.0, 0.5 * g / cosine2 - 1))
    state[OMEGA] = speed if up > down else -speed
    state[X_C] = x_start + 2 * asin(max(-1.0, min(1.0, sine)))
    if reason == PHASE_OVER:
        if turn_at < time:
            state[OMEGA] = 0.0
            return TURNS_REACHED if turn(par, state, events) else PHASE_OVER
        begin(par, state, SKIM, events)
    return reason
