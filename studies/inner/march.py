"""The inner problem: hoop and scaled patch around an instant of the rigid motion, without any stiffness left in it.

    p = max(0, -H - s^2/2),    N_el = (2/3) A^3,   A = sqrt(-2 H),    N = N_el + theta N_el' >= 0
    psi' = eps Omega,   Omega' = eps alpha,   H'' = ddot h,   V' = dot v     (:mod:`studies.inner.body`, ' = d/dtau)

With ``eps`` = 0 the angle and phidot stand still: the inner problem proper, the same for every stiffness. With eps > 0
the same equations are the whole rigid ring on a foundation of eps^-3, to relative order eps, and run through a pulse.

Friction, by law: ``patch`` sticks (F = -kappa times the total stretch of the bristles, less theta kappa 2 A V of the
damper) until |F| > mu_s N, slides with F = -+ mu N until V changes sign, and then begins to stick with bristles that
hold mu N (where N rings, undamped, the flexible solver's patch sticks a little before, as it asks when the feet of its
bristles stand; a slip that comes to its end by the rigid motion has N' = 0 here). ``brush`` has that threshold at each
bristle. ``regularised`` is F = -mu N V/sqrt(V^2 + V_s^2).
Explicit Runge-Kutta of order four, its step a fraction of the patch's own period; events end a step.
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any

import numpy as np

from rigid.kernel.compile import jit, part

from . import body as mechanics
from .bristles import brush_pull, set_stretch, step_on, total_stretch, way_of_sliding

PATCH, BRUSH, REGULARISED = range(3)  # the codes of the laws in flexible.contact.laws, each in its scaled form here
STICK, SLIDE_RIGHT, SLIDE_LEFT = 0, 1, -1  # a spinning hoop is pushed to the right
# positions in the state of the march
PSI, OMEGA, SLIP, HEIGHT, RATE, WAY, ROLLED, NORMAL_IMPULSE, FRICTION_IMPULSE, FRICTION_WORK = range(10)
STATE = 10
# columns of a record
COLUMNS = ("tau", "normal_force", "friction_force", "slip", "height", "mode", "psi", "omega")

System = namedtuple("System", ["body", "contact", "eps"])
System.__doc__ = "A hoop, its contact, and eps: 0 for the inner problem, the small parameter itself for a whole motion."

ScaledContact = namedtuple("ScaledContact", ["law", "kappa", "mu_s", "mu", "theta", "slip_scale"])
ScaledContact.__doc__ = "Law, tangential ratio, coefficients, relaxation time and V_s on the scaled clock."

_arms = part(mechanics.arms)
_AT_ONCE = 1e-9  # of the excess: nearer to a switch than that is at it
NARROW = 0.2  # of the half-width at the start: a patch below it is taken to be that wide when a step is chosen


@part
def _normal(state: Any, theta: float) -> tuple[float, float, float]:
    """(A, N, eta = N/N_el)."""
    if state[HEIGHT] >= 0:
        return 0.0, 0.0, 1.0
    half = np.sqrt(-2 * state[HEIGHT])
    eta = max(0.0, 1 - 3 * theta * state[RATE] / (half * half))
    return half, eta * 2 / 3 * (half * half * half), eta


@part
def _forces(state: Any, contact: Any, mode: int, kept: Any) -> tuple[float, float]:
    """(N, F) at a state, with the bristles as the last step left them."""
    half, normal, eta = _normal(state, contact.theta)
    if half == 0:
        return 0.0, 0.0
    slip = state[SLIP]
    if contact.law == REGULARISED:
        return normal, -contact.mu * normal * slip / np.sqrt(slip * slip + contact.slip_scale * contact.slip_scale)
    if contact.law == BRUSH:
        return normal, brush_pull(kept, contact, half, state[ROLLED], state[WAY], eta, False)[0]
    if mode != STICK:
        return normal, mode * contact.mu * normal
    stretch = total_stretch(kept, half, state[ROLLED], state[WAY])
    return normal, -contact.kappa * (stretch + contact.theta * 2 * half * slip)


@part
def _rates(state: Any, system: Any, mode: int, kept: Any) -> Any:
    """Derivatives of the state by tau."""
    body, eps = system.body, system.eps
    normal, friction = _forces(state, system.contact, mode, kept)
    a, b, ec = _arms(body.e, body.one_minus_e, state[PSI])
    w = state[OMEGA] * state[OMEGA]
    alpha = (normal * a - friction * b) / body.gyration
    out = np.empty(STATE)
    out[PSI], out[OMEGA] = eps * state[OMEGA], eps * alpha
    out[SLIP] = friction - b * alpha + a * w
    out[HEIGHT], out[RATE] = state[RATE], normal - 1 + a * alpha + ec * w
    out[WAY], out[ROLLED] = state[SLIP], state[OMEGA]
    out[NORMAL_IMPULSE], out[FRICTION_IMPULSE], out[FRICTION_WORK] = normal, friction, friction * state[SLIP]
    return out


@part
def _advance(state: Any, system: Any, mode: int, kept: Any, h: float) -> Any:
    """One Runge-Kutta step of length ``h``."""
    total, at = np.zeros(STATE), state
    for stage in range(4):
        k = _rates(at, system, mode, kept)
        at = np.empty(STATE)
        share = h if stage == 2 else h / 2
        for i in range(STATE):  # expressions of whole arrays take long to compile
            total[i] += k[i] if stage in (0, 3) else 2 * k[i]
            at[i] = state[i] + share * k[i]
    for i in range(STATE):
        total[i] = state[i] + h / 6 * total[i]
    return total


@part
def _excess(state: Any, contact: Any, mode: int, kept: Any) -> float:
    """Positive where the patch can no longer go on as it does."""
    if contact.law != PATCH:
        return -1.0
    normal, friction = _forces(state, contact, mode, kept)
    if mode == STICK:
        return abs(friction) - contact.mu_s * normal
    return mode * state[SLIP] if normal > 0 else -1.0


@part
def _step_length(state: Any, body: Any, contact: Any, widest: float) -> float:
    """The inverse of the fastest rate that is at work."""
    half, normal, _ = _normal(state, contact.theta)
    half = max(half, NARROW * widest)
    a, b, _ = _arms(body.e, body.one_minus_e, state[PSI])
    square = 2 * half * (1 + a * a / body.gyration + contact.kappa * (1 + b * b / body.gyration))
    # an overdamped approach follows N; its rate counts for stability alone
    rate = max(np.sqrt(square), contact.theta * square / 4, abs(state[OMEGA]) / half)
    if contact.law == REGULARISED:
        rate = max(rate, contact.mu * normal * (1 + b * b / body.gyration) / contact.slip_scale)
    return 1 / rate


@part
def _switch(state: Any, contact: Any, mode: int, kept: Any) -> int:
    """What a patch does next whose law has just been exceeded; one that sticks gets the bristles that hold mu N."""
    half, _, eta = _normal(state, contact.theta)
    turned = mode
    if mode == STICK:
        turned = SLIDE_RIGHT if _forces(state, contact, mode, kept)[1] > 0 else SLIDE_LEFT
        if turned * state[SLIP] <= 0:
            return turned
    # no more than mu N_el: what a damper adds to the pressure is no spring. A patch that breaks the way it does not
    # move has let go of what was too much, and sticks again
    most = turned * contact.mu * min(eta, 1.0) / contact.kappa
    state[WAY], state[ROLLED] = 0.0, 0.0
    set_stretch(kept, half, np.array([-most * half * half / 2, 0.0, most / 2]), False)
    return STICK


@part
def _note(row: Any, tau: float, state: Any, contact: Any, mode: int, kept: Any) -> None:
    """Fill a record."""
    row[1], row[2] = _forces(state, contact, mode, kept)
    if contact.law == BRUSH and _normal(state, contact.theta)[0] > 0:
        mode = way_of_sliding(kept)
    row[0], row[3], row[4], row[5] = tau, state[SLIP], state[HEIGHT], mode
    row[6], row[7] = state[PSI], state[OMEGA]


@part
def _cut(state: Any, system: Any, mode: int, kept: Any, h: float, event: bool, psi_end: float) -> Any:
    """The part of a step of length ``h`` that ends at an event or at an angle: (length, state, event, at the angle)."""
    low, high = 0.0, h
    after, late = state, False
    while high - low > 1e-14 * h:
        middle = (low + high) / 2
        if middle in (low, high):
            break
        found = _advance(state, system, mode, kept, middle)
        is_late = (found[PSI] - psi_end) * state[OMEGA] > 0
        broken = event and _excess(found, system.contact, mode, kept) > 0
        if is_late or broken:
            high, after, event, late = middle, found, broken, is_late
        else:
            low = middle
    if high == h:
        after = _advance(state, system, mode, kept, h)
        late = (after[PSI] - psi_end) * state[OMEGA] > 0
    return high, after, event, late


@part
def _settled(state: Any, system: Any, mode: int, kept: Any) -> int:
    """Bring the bristles up to date after a step; the mode, which is another where the patch is off the floor."""
    contact = system.contact
    half, _, eta = _normal(state, contact.theta)
    if contact.law == BRUSH:
        brush_pull(kept, contact, half, state[ROLLED], state[WAY], eta, True)
    elif contact.law == PATCH and half == 0 and state[SLIP] != 0:  # what comes down comes down sliding
        return SLIDE_LEFT if state[SLIP] > 0 else SLIDE_RIGHT
    elif contact.law == PATCH and mode == STICK and half > 0:
        step_on(kept, half, state[ROLLED], state[WAY])
    return mode


@part
def _twice_as_long(rows: Any) -> Any:
    """The same rows with room for as many again."""
    longer = np.empty((2 * rows.shape[0], rows.shape[1]))
    for i in range(rows.shape[0]):
        for k in range(rows.shape[1]):
            longer[i, k] = rows[i, k]
    return longer


@jit
def march(system: Any, start: Any, mode: int, kept: Any, ends: Any) -> Any:
    """March from ``start`` on.

    Parameters
    ----------
    system : System
    start : (STATE,) array
    mode : int
        STICK, SLIDE_RIGHT or SLIDE_LEFT (``patch``).
    kept : Bristles
        Is changed.
    ends : (5,) array
        Duration in tau, angle psi, fraction of the fastest time to a step, steps to a record, most steps.

    Returns
    -------
    records : (n, 8) array
        See ``COLUMNS``; a switch of the mode has two records.
    switches : (m, 2) array
        tau and the new mode.
    state : (STATE,) array
        At the end.
    done : bool
        Whether that is one of the ends, and not that of the steps.
    """
    contact, state = system.contact, start.copy()
    tau, steps, rows, marks = 0.0, 0, 0, 0
    widest = max(_normal(state, 0.0)[0], 1.0)
    records, switches = np.empty((1024, len(COLUMNS))), np.empty((64, 2))
    # right at a switch the excess is round-off of zero; a march that goes on from a state before one must see it
    running, fresh = True, _excess(state, contact, mode, kept) > -_AT_ONCE
    _note(records[rows], tau, state, contact, mode, kept)
    rows += 1
    while running and steps < ends[4]:
        h = ends[2] * _step_length(state, system.body, contact, widest)
        if fresh or steps == 0:
            h /= 8
        if tau + h >= ends[0]:
            h, running = ends[0] - tau, False
        after = _advance(state, system, mode, kept, h)
        event = not fresh and _excess(after, contact, mode, kept) > 0
        if event or (after[PSI] - ends[1]) * state[OMEGA] > 0:
            h, after, event, late = _cut(state, system, mode, kept, h, event, ends[1])
            running = not late
        tau, state, fresh = tau + h, after, False
        steps += 1
        turned = _settled(state, system, mode, kept)
        switching = (event and running) or turned != mode
        if rows + 2 >= records.shape[0]:
            records = _twice_as_long(records)
        if switching or not running or steps % int(ends[3]) == 0:
            _note(records[rows], tau, state, contact, mode, kept)
            rows += 1
        if switching:
            if turned == mode:
                if mode != STICK:
                    state[SLIP] = 0.0
                turned = _switch(state, contact, mode, kept)
            mode, fresh = turned, True
            _note(records[rows], tau, state, contact, mode, kept)
            rows += 1
            if marks == switches.shape[0]:
                switches = _twice_as_long(switches)
            switches[marks, 0], switches[marks, 1] = tau, mode
            marks += 1
    return records[:rows].copy(), switches[:marks].copy(), state, not running
