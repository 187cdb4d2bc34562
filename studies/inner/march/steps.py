"""Steps of the march in time: explicit, and implicit in what is far faster than the rest of a layer.

A strong damper holds H' and V of a patch to what its forces ask, at a rate of theta 2 A times the contact point's
mobility, and sharply smoothed friction does so with V; the rest of a layer is as slow as ever. There a step is
extrapolated from linearly implicit Euler steps, 1 to 4 of them, in which N and F are taken at their end, by what they
gain from H' and V (:func:`.equations.slopes`): of order four as the explicit one, and what is fast dies in it. It works
with products alone, so that it is the same to the last bit compiled or not.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rigid.kernel.compile import part

from .equations import (
    OMEGA,
    PSI,
    RATE,
    REGULARISED,
    SLIP,
    STATE,
    arms,
    forces,
    moved,
    normal_force,
    slopes,
)  # fmt: skip

NARROW = 0.2  # of the half-width at the start: a patch below it is taken to be that wide when a step is chosen
STIFF = 10.0  # times the slower rates: what is faster is not worth explicit steps
_TABLEAU = (-1 / 6, 4.0, -27 / 2, 32 / 3)  # of 1 to 4 steps of Euler: their errors of order h, h^2 and h^3 cancel


@part
def advance(state: Any, system: Any, mode: int, kept: Any, h: float, implicit: bool) -> Any:
    """One step of length ``h``."""
    total = np.zeros(STATE)
    if implicit:
        for n in range(4):
            at = _euler(state, system, mode, kept, h, n + 1)
            for i in range(STATE):
                total[i] += _TABLEAU[n] * (at[i] - state[i])
        for i in range(STATE):
            total[i] = state[i] + total[i]
        return total
    at = state
    for stage in range(4):
        normal, friction = forces(at, system.contact, mode, kept)
        k = moved(at, system.body, system.eps, normal, friction)
        at = np.empty(STATE)
        share = h if stage == 2 else h / 2
        for i in range(STATE):  # expressions of whole arrays take long to compile
            total[i] += k[i] if stage in (0, 3) else 2 * k[i]
            at[i] = state[i] + share * k[i]
    for i in range(STATE):
        total[i] = state[i] + h / 6 * total[i]
    return total


@part
def _euler(state: Any, system: Any, mode: int, kept: Any, whole: float, count: int) -> Any:
    """``count`` linearly implicit steps of Euler, of a ``whole`` length."""
    body, eps, h = system.body, system.eps, whole / count
    at = state.copy()
    for _ in range(count):
        normal, friction = forces(at, system.contact, mode, kept)
        by_rate, drag_by_rate, by_slip = slopes(at, system.contact, mode, kept, normal)
        a, b, _ = arms(body.e, body.one_minus_e, at[PSI])
        up, across, along = 1 + a * a / body.gyration, -a * b / body.gyration, 1 + b * b / body.gyration
        now = moved(at, body, eps, normal, friction)
        # (1 - h J) (k_H', k_V) = (ddot h, dot v) of the forces at the start
        j11, j12 = 1 - h * (up * by_rate + across * drag_by_rate), -h * across * by_slip
        j21, j22 = -h * (across * by_rate + along * drag_by_rate), 1 - h * along * by_slip
        det = j11 * j22 - j12 * j21
        rate = (j22 * now[RATE] - j12 * now[SLIP]) / det
        slip = (j11 * now[SLIP] - j21 * now[RATE]) / det
        normal += h * by_rate * rate
        friction += h * (drag_by_rate * rate + by_slip * slip)
        if normal < 0:
            normal, friction = 0.0, 0.0
        ends = at.copy()
        ends[RATE], ends[SLIP] = at[RATE] + h * rate, at[SLIP] + h * slip
        k = moved(ends, body, eps, normal, friction)
        for i in range(STATE):
            at[i] += h * k[i]
    return at


@part
def step_length(state: Any, system: Any, mode: int, kept: Any, widest: float, since: float) -> tuple[float, bool]:
    """The inverse of the fastest rate that is to be followed, and whether a step of it is implicit.

    ``since`` the last change of what the patch does what is fast dies away: it is followed as long as it is there.
    """
    body, contact = system.body, system.contact
    half, normal, _ = normal_force(state, contact.theta)
    half = max(half, NARROW * widest)
    a, b, _ = arms(body.e, body.one_minus_e, state[PSI])
    along = 1 + b * b / body.gyration
    square = 2 * half * (1 + a * a / body.gyration + contact.kappa * along)
    slow, fast = max(np.sqrt(square), abs(state[OMEGA]) / half), contact.theta * square
    # an overdamped approach follows N; its rate counts for the stability of explicit steps alone
    stable = max(slow, fast / 4)
    if contact.law == REGULARISED:
        stable = max(stable, contact.mu * normal * along / contact.slip_scale)
    if stable <= STIFF * slow:
        return 1 / stable, False
    if contact.law == REGULARISED:
        slip, scale = state[SLIP], contact.slip_scale
        friction = forces(state, contact, mode, kept)[1]
        quickening = abs(moved(state, body, system.eps, normal, friction)[SLIP])
        slow = max(slow, quickening / np.sqrt(slip * slip + scale * scale))
        fast = max(fast, contact.mu * normal * along / scale)
    return min(1 / slow, max(1 / fast, since)), True
