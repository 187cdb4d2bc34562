"""The inner problem: hoop and scaled patch around an instant of the rigid motion, without any stiffness left in it.

With ``eps`` = 0 the angle and phidot stand still: the inner problem proper, the same for every stiffness. With eps > 0
the same equations are the whole rigid ring on a foundation of eps^-3, to relative order eps, and run through a pulse.

A ``patch`` sticks until |F| > mu_s N, slides with F = -+ mu N until V changes sign, and then begins to stick with
bristles that hold mu N (where N rings, undamped, the flexible solver's patch sticks a little before, as it asks when
the feet of its bristles stand; a slip that comes to its end by the rigid motion has N' = 0 here). ``brush`` has that
threshold at each bristle. Steps (:mod:`.steps`) are a fraction of the patch's own period; events end a step.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.kernel.compile import jit, part

from .bristles import brush_pull, set_stretch, step_on, way_of_sliding
from .equations import (
    BRUSH,
    HEIGHT,
    OMEGA,
    PATCH,
    PSI,
    ROLLED,
    SLIDE_LEFT,
    SLIDE_RIGHT,
    SLIP,
    STICK,
    WAY,
    forces,
    normal_force,
)  # fmt: skip
from .steps import advance, step_length

# columns of a record
COLUMNS = ("tau", "normal_force", "friction_force", "slip", "height", "mode", "psi", "omega")
_AT_ONCE = 1e-9  # of the excess: nearer to a switch than that is at it


@part
def _excess(state: Any, contact: Any, mode: int, kept: Any) -> float:
    """Positive where the patch can no longer go on as it does."""
    if contact.law != PATCH:
        return -1.0
    normal, friction = forces(state, contact, mode, kept)
    if mode == STICK:
        return abs(friction) - contact.mu_s * normal
    return mode * state[SLIP] if normal > 0 else -1.0


@part
def _switch(state: Any, contact: Any, mode: int, kept: Any) -> int:
    """What a patch does next whose law has just been exceeded; one that sticks gets the bristles that hold mu N."""
    half, _, eta = normal_force(state, contact.theta)
    turned = mode
    if mode == STICK:
        turned = SLIDE_RIGHT if forces(state, contact, mode, kept)[1] > 0 else SLIDE_LEFT
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
    row[1], row[2] = forces(state, contact, mode, kept)
    if contact.law == BRUSH and normal_force(state, contact.theta)[0] > 0:
        mode = way_of_sliding(kept)
    row[0], row[3], row[4], row[5] = tau, state[SLIP], state[HEIGHT], mode
    row[6], row[7] = state[PSI], state[OMEGA]


@part
def _cut(state: Any, system: Any, mode: int, kept: Any, step: tuple[float, bool], event: bool, psi_end: float) -> Any:
    """The part of a step that ends at an event or at an angle: (length, state, event, at the angle)."""
    h, implicit = step
    low, high = 0.0, h
    after, late = state, False
    while high - low > 1e-14 * h:
        middle = (low + high) / 2
        if middle in (low, high):
            break
        found = advance(state, system, mode, kept, middle, implicit)
        is_late = (found[PSI] - psi_end) * state[OMEGA] > 0
        broken = event and _excess(found, system.contact, mode, kept) > 0
        if is_late or broken:
            high, after, event, late = middle, found, broken, is_late
        else:
            low = middle
    if high == h:
        after = advance(state, system, mode, kept, h, implicit)
        late = (after[PSI] - psi_end) * state[OMEGA] > 0
    return high, after, event, late


@part
def _settled(state: Any, system: Any, mode: int, kept: Any) -> int:
    """Bring the bristles up to date after a step; the mode, which is another where the patch is off the floor."""
    contact = system.contact
    half, _, eta = normal_force(state, contact.theta)
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
    tau, changed, steps, rows, marks = 0.0, 0.0, 0, 0, 0
    widest = max(normal_force(state, 0.0)[0], 1.0)
    records, switches = np.empty((1024, len(COLUMNS))), np.empty((64, 2))
    # right at a switch the excess is round-off of zero; a march that goes on from a state before one must see it
    running, fresh = True, _excess(state, contact, mode, kept) > -_AT_ONCE
    _note(records[rows], tau, state, contact, mode, kept)
    rows += 1
    while running and steps < ends[4]:
        h, implicit = step_length(state, system, mode, kept, widest, tau - changed)
        h *= ends[2]
        if fresh or steps == 0:
            h /= 8
        if tau + h >= ends[0]:
            h, running = ends[0] - tau, False
        after = advance(state, system, mode, kept, h, implicit)
        event = not fresh and _excess(after, contact, mode, kept) > 0
        if event or (after[PSI] - ends[1]) * state[OMEGA] > 0:
            h, after, event, late = _cut(state, system, mode, kept, (h, implicit), event, ends[1])
            running = not late
        tau, fresh = tau + h, False
        if normal_force(state, contact.theta)[1] == 0 < normal_force(after, contact.theta)[1]:
            changed = tau  # it touches
        state = after
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
            mode, fresh, changed = turned, True, tau
            _note(records[rows], tau, state, contact, mode, kept)
            rows += 1
            if marks == switches.shape[0]:
                switches = _twice_as_long(switches)
            switches[marks, 0], switches[marks, 1] = tau, mode
            marks += 1
    return records[:rows].copy(), switches[:marks].copy(), state, not running
