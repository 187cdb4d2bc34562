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
    HITS_FLOOR,
    IMPACT,
    LIFTED,
    MODE,
    MU,
    MU_S,
    OMEGA,
    PERIOD,
    PHASE_OVER,
    PULSE_OVER,
    RESTS,
    ROLL,
    SKIM,
    SLIP,
    T_END,
    TIME_REACHED,
    TOP,
    TURNS_REACHED,
    UNTIL,
    WHOLE,
    X_C,
    XDOT,
    T,
)
from ..record.events import begin, turn
from ..record.pulse import watch
from .rolling.closed_form import TIE

JUST_NOW = 1e-7  # a slip that begins is 0 no sooner again


@kernel
def choose_point_mass(par, state, events):
    """A point mass on a massless hoop rolls while |tan(phi/2)| <= mu_s and N >= 0, else the hoop skims, N =
    F = 0.
    """
    s, _, h, _low = trig(state[ANGLE], state[TOP])
    if s == 0.0 and h > 0.0 and (par[MU] > 0.0 or state[OMEGA] == 0.0):
        catch(state)  # upright, without a blow
    if state[SLIP] * s < 0.0 and abs(s) < par[MU] * h:
        state[MODE] = IMPACT
    elif state[SLIP] == 0.0 and holds(par, s, h, state[OMEGA]):
        begin(par, state, ROLL, events)
    else:
        begin(par, state, SKIM, events)


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


@kernel
def skim(par, state, events):
    """The point mass in free fall, the massless hoop skimming under it without a force, to the turn or to
    the floor.
    """
    if watch(par, state, 0.0, events) and par[UNTIL] == FIRST_PULSE:
        return PULSE_OVER
    a, top, omega = state[ANGLE], state[TOP], state[OMEGA]
    s, _c, h, low = trig(a, top)
    ydot = -s * omega
    # height h + ydot t - t^2/2: to the floor, and over the reach of the hoop (h = 2) if it rises that high
    to_floor = ydot + sqrt(ydot * ydot + 2 * h)
    to_lift = inf
    if ydot > 0 and ydot * ydot >= 2 * low:
        to_lift = 2 * low / (ydot + sqrt(ydot * ydot - 2 * low))
    to_turn = ydot if ydot > 0 else inf
    to_stop, to_catch = until_slip_stops(par, state), until_caught(par, state)
    time = min(to_floor, to_lift, to_turn, to_stop, to_catch)
    reason = PHASE_OVER
    if state[T] + time >= par[T_END]:
        time, reason = par[T_END] - state[T], TIME_REACHED
    elif time == to_stop:
        drop(state, time)
        state[SLIP] = 0.0
        return PHASE_OVER
    elif time == to_catch:
        drop(state, time)
        state[MODE] = IMPACT
        return PHASE_OVER
    elif time == to_lift:
        reason = LIFTED
    elif time == to_floor:
        reason = HITS_FLOOR
    drop(state, time)
    if reason == PHASE_OVER:
        state[OMEGA] = 0.0
        if turn(par, state, events):
            return TURNS_REACHED
    elif reason == TIME_REACHED:
        state[T] = par[T_END]
    return reason


@kernel
def until_slip_stops(par, state):
    """Time to where a skimming hoop has no slip and rolls on, infinite without one.

    With tau since the mass is (or was, or would be) highest, at h = H, v = xdot - sgn(s) tau sqrt(h/(2 - h)) and
    h = H - tau^2/2: a quadratic in tau^2.
    """
    s, _c, h, low = trig(state[ANGLE], state[TOP])
    ydot, xdot = -s * state[OMEGA], state[XDOT]
    highest, under = h + 0.5 * ydot * ydot, low - 0.5 * ydot * ydot  # of the floor, and of the top: H and 2 - H
    half = highest - 0.5 * xdot * xdot
    root = half * half - 2 * xdot * xdot * under
    if root < 0.0 or half <= 0.0:
        return inf
    large = half + sqrt(root)
    found = inf
    for z in (large, 2 * xdot * xdot * under / large):
        tau = sqrt(max(z, 0.0))
        time = ydot + (tau if xdot * s > 0.0 else -tau)
        if time <= (JUST_NOW if state[SLIP] == 0.0 else 0.0) or time >= found:
            continue
        then = highest - 0.5 * z
        across = sqrt(max(then * (under + 0.5 * z), 0.0))
        if across > 0.0 and holds(par, across, then, (time - ydot) / across):
            found = time
    return found


@kernel
def until_caught(par, state):
    """Time to where a skimming hoop that comes up is as steep as mu and slips down that slope, infinite if never."""
    s, _c, h, _low = trig(state[ANGLE], state[TOP])
    ydot, mu = -s * state[OMEGA], par[MU]
    steep = 2 / (1 + mu * mu)
    left = ydot * ydot - 2 * (steep - h)
    if ydot <= 0.0 or h >= steep or left < 0.0:
        return inf
    time = ydot - sqrt(left)
    slip = state[XDOT] - (time - ydot) * (1 / mu if s > 0.0 else -1 / mu)
    return time if slip * s < 0.0 else inf


@kernel
def skimming_acceleration(omega, a, top):
    """phiddot of the falling point mass, from d^2(cos phi)/dt^2 = -1; 0, as :func:`drop` has it for phidot, right on
    top and at the floor, where it has no finite value.
    """
    s, c, _, _ = trig(a, top)
    return (1 - c * omega * omega) / s if s != 0.0 else 0.0


@kernel
def drop(state, time):
    """Advance a skimming point mass."""
    a, top, whole, omega = state[ANGLE], state[TOP], state[WHOLE], state[OMEGA]
    s, _c, h, low = trig(a, top)
    xdot = state[XDOT]
    ydot = -s * omega
    fall = ydot * time - 0.5 * time * time
    # the side of the hoop does not change on the way
    right = s > 0 or (s == 0.0 and (omega > 0) == (top != 0.0))
    h1, low1 = max(h + fall, 0.0), max(low - fall, 0.0)
    if h1 <= 1.0:
        offset, top1 = 2 * asin(sqrt(0.5 * h1)), 0.0
    else:
        offset, top1 = 2 * asin(sqrt(0.5 * low1)), 1.0
    # phi in (0, pi) on the right, (pi, 2 pi) on the left of the hoop
    turns = whole
    if top != 0.0 and not right:
        turns = whole - 1.0
    if top1 == 0.0:
        a1, whole1 = (-offset if right else offset), turns
    else:
        a1 = offset if right else -offset
        whole1 = turns if right else turns + 1.0
    s1, _, _, _ = trig(a1, top1)
    v_y = ydot - time
    state[OMEGA] = -v_y / s1 if s1 != 0.0 else 0.0
    state[X_C] += xdot * time - (s1 - s)
    state[SLIP] = xdot - state[OMEGA] * h1
    state[ANGLE], state[TOP], state[WHOLE] = a1, top1, whole1
    state[T] += time
