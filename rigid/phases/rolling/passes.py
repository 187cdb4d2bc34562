"""A pass over the bottom: the places that it meets and when, counted from the bottom."""

# mypy: allow-untyped-defs
from __future__ import annotations

from math import asin, atan, inf, sqrt, tan
from typing import NamedTuple

from ...kernel.angle import trig
from ...kernel.compile import kernel
from ...kernel.layout import ANGLE, OMEGA, S_MINUS, S_PLUS, S_SIN, TOP, WHOLE, ZETA
from .closed_form import angle_at_time, headroom_at, pulse_edge, rolling_time, slip_edges, turning_point

# the places of interest on a pass
SLIP_IN, PULSE_BEGINS, BOTTOM, PULSE_ENDS, SLIP_OUT, FAR_END = range(6)


class Place(NamedTuple):
    """A place of interest: |psi| as (|offset|, chart), the time from the bottom to it, and G - h there."""

    offset: float
    top: float
    time: float
    headroom: float


class Pass(NamedTuple):
    """What a pass over the bottom meets. The pull of a slip is the sign of F sin phi there, 0 where nothing slips.

    Places beyond the first slip ahead, which ends the rolling, are given no time: inf.
    """

    far_end: Place  # the turn, or the top
    pulse_edge: Place  # N = M g
    slip_in: Place
    slip_out: Place
    pull_in: float
    pull_out: float
    h_pulse: float  # 1 + cos phi at the pulse's edge
    now: float  # time from the bottom to the angle at which the phase begins
    lossless: bool  # no slip on the way: every pass is like this one


@kernel
def half_angle(h):
    """(|offset|, chart) of a height h = 1 + cos phi."""
    if h <= 1.0:
        return 2 * asin(sqrt(0.5 * h)), 0.0
    return 2 * asin(sqrt(max(0.0, 0.5 * (2 - h)))), 1.0


@kernel
def direction(omega, s):
    """Sign of phidot, now or from now on."""
    return 1.0 if (omega > 0 or (omega == 0.0 and s > 0)) else -1.0


@kernel
def bottom_of(a, top, whole, d):
    """Number of the bottom whose pass this is, on the way in direction ``d``."""
    if top != 0.0 and (a < 0.0 or (a == 0.0 and d < 0)):
        return whole - 1.0
    return whole


@kernel
def side_of(a, top, d):
    """Sign of psi = phi - pi: the side of the bottom, at the bottom or the top the one ahead or behind."""
    if a == 0.0:
        return d if top == 0.0 else -d
    return (1.0 if a > 0 else -1.0) if top == 0.0 else (-1.0 if a > 0 else 1.0)


@kernel
def place_at(zeta, g, below, offset, top, met):
    """The place at an angle; without its time unless it is ``met``."""
    _, _, h, low = trig(offset, top)
    headroom = headroom_at(g, below, offset, top)
    return Place(offset, top, rolling_time(zeta, g, h, low, headroom) if met else inf, headroom)


@kernel
def put(state, side, place, bottom):
    """Set the angle to a place on one side of the bottom of that number."""
    if place.top == 0.0:
        state[ANGLE], state[TOP], state[WHOLE] = side * place.offset, 0.0, bottom
    elif side > 0:
        state[ANGLE], state[TOP], state[WHOLE] = -place.offset, 1.0, bottom + 1
    else:
        state[ANGLE], state[TOP], state[WHOLE] = place.offset, 1.0, bottom


@kernel
def place_in(zeta, g, below, time):
    """The place that is reached at a time from the bottom."""
    offset, top, headroom = angle_at_time(zeta, g, below, time)
    return Place(offset, top, time, headroom)


@kernel
def before(offset, top, place):
    """Whether an angle is nearer to the bottom than a place."""
    if top != place.top:
        return top == 0.0
    return offset > place.offset if top != 0.0 else offset < place.offset


@kernel
def pass_from(par, state, g, below, heading, work):
    """The pass that the present state is on, in the direction ``heading``."""
    zeta, a, top, omega = par[ZETA], state[ANGLE], state[TOP], state[OMEGA]
    _, _, h, low = trig(a, top)
    inner, inner_top, pull_in, outer, outer_top, pull_out = slip_edges(
        par, g, below, a, top, work[S_PLUS], work[S_MINUS], work[S_SIN]
    )
    slips_in, slips_out = inner >= 0, outer >= 0
    inwards = side_of(a, top, heading) * heading < 0
    now = rolling_time(zeta, g, h, low, 0.5 * omega * omega * (zeta + 2 * h))
    turn_a, turn_top = turning_point(g, below)
    t_turn = inf
    if omega == 0.0:
        turn_a, turn_top, t_turn = abs(a), top, now
    elif not (slips_out or (inwards and slips_in)):
        t_turn = rolling_time(zeta, g, min(g, 2.0), max(below, 0.0), max(-below, 0.0))
    far_end = Place(turn_a, turn_top, t_turn, max(-below, 0.0))
    y = tan(0.5 * abs(a))
    slip_in = slip_out = Place(0.0, 0.0, inf, 0.0)
    if slips_in:
        slip_in = place_at(zeta, g, below, 2 * atan(inner), inner_top, inwards or not slips_out)
        if inner == y and inner_top == top:
            slip_in = Place(slip_in.offset, slip_in.top, now, slip_in.headroom)
    if slips_out:
        slip_out = place_at(zeta, g, below, 2 * atan(outer), outer_top, not (inwards and slips_in))
        if outer == y and outer_top == top:
            slip_out = Place(slip_out.offset, slip_out.top, now, slip_out.headroom)
    h_pulse = pulse_edge(zeta, g)
    edge_a, edge_top = half_angle(h_pulse)
    if inwards and slips_in:
        met = not before(edge_a, edge_top, slip_in)
    else:
        met = before(edge_a, edge_top, slip_out) or not slips_out
    edge = place_at(zeta, g, below, edge_a, edge_top, met)
    return Pass(
        far_end,
        edge,
        slip_in,
        slip_out,
        pull_in if slips_in else 0.0,
        pull_out if slips_out else 0.0,
        h_pulse,
        now,
        not (slips_in or slips_out),
    )


@kernel
def next_place(way, now):
    """(time, which) of the next place of interest after the time ``now`` from the bottom."""
    time, which = way.far_end.time, FAR_END
    if way.pull_out != 0.0 and now <= way.slip_out.time:
        time, which = way.slip_out.time, SLIP_OUT
    if now < way.pulse_edge.time < time:
        time, which = way.pulse_edge.time, PULSE_ENDS
    if now < 0.0:
        time, which = 0.0, BOTTOM
        if way.pull_in != 0.0:
            time, which = -way.slip_in.time, SLIP_IN
    if now < -way.pulse_edge.time and (which == BOTTOM or -way.pulse_edge.time < time):
        time, which = -way.pulse_edge.time, PULSE_BEGINS
    return time, which
