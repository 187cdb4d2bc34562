"""What bristles do between the beginning of a step and where in it their points left the floor."""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

from rigid.kernel.compile import loop

from .data import Before, Bristles, Parameters, Rim, Slip
from .dent import dent_at, displaced, next_dent
from .rim import lift


@loop
def work_of_those_that_left(
    points: Any, before: Before, rim: Rim, slip: Slip, moved: float, dphi: float, law: Parameters, stuck: float
) -> float:
    """Work of the bristles now farther off the patch than its neighbours, beyond their force times the mean way.

    They left one after the other, as evenly as the patch's edge went over them: those that stuck with what they pulled
    then, those that slid with nothing.
    """
    bristles = before.bristles
    number, last = bristles.number, bristles.number.shape[0] - 1
    low, high = points.number[0], points.number[-1]
    work = 0.0
    was = left = dent_at(before, rim, pi - before.pose[2])
    for i in range(number.shape[0]):
        j = number[i]
        if j > high:
            share = (number[last] + 0.5 - j) / (number[last] - high)
        elif j < low:
            share = (j - number[0] + 0.5) / (low - number[0])
        else:
            continue
        theta = j * law.spacing + share * dphi
        rolled = share * dphi * lift(before.pose[2] - pi + theta - share * dphi / 2)
        was, left = next_dent(was, before, rim, j * law.spacing), next_dent(left, before, rim, theta)
        rolled += displaced(left, theta)[0] - displaced(was, j * law.spacing)[0]
        pull = bristles.pull[i] / 2
        if stuck > 0 and abs(bristles.sliding[i]) != 1 and bristles.stretch[i] != 0:
            pull = bristles.pull[i] - law.eps_t * law.spacing * (rolled + share * moved) / 2
        work += pull * (rolled - share * (slip.way - moved))
    return work


@loop
def all_stick(weight: Any, sliding: Any) -> bool:
    """Whether points bear on the floor, and none of them slides."""
    bear, slide = 0, 0
    for i in range(weight.shape[0]):
        bear += 1 if weight[i] > 0 else 0
        slide += 1 if weight[i] > 0 and abs(sliding[i]) == 1 else 0
    return bear > 0 and slide == 0


@loop
def those_that_bear(weight: Any) -> tuple[int, int]:
    """First and last of them."""
    first, last = 0, weight.shape[0] - 1
    while first < last and weight[first] <= 0:
        first += 1
    while first < last and weight[last] <= 0:
        last -= 1
    return first, last


class Edge(NamedTuple):
    """An edge of a patch that sticks."""

    stretch: float  # of the bristles there
    slope: float  # of that, over the points' distance, outward
    place: float  # in points, outward


@loop
def _edge_of(number: Any, stretch: Any, pull: Any, side: int, spring: float) -> Edge:
    """The edge on the ``side`` of greater (1) or smaller (-1) angles; a point that bears its cell has that ``spring``.

    What the last two bear says how far the edge is, and up to there bristles are stretched along the line through them.
    """
    last = number.shape[0] - 1
    bear, outer, slope, outermost, found = 0.0, 0.0, 0.0, 0, 0
    i = last if side > 0 else 0
    while found < 2 and 0 <= i <= last:
        if stretch[i] != 0 and pull[i] != 0:
            bear -= pull[i] / stretch[i] / spring
            if found == 0:
                outer, outermost = stretch[i], side * number[i]
            else:
                slope = outer - stretch[i]
            found += 1
        i -= side
    beyond = min(bear, 2.0) - 1.5 if found == 2 else 1.0
    return Edge(outer + beyond * slope, slope, outermost + beyond)


@loop
def _borne(d: float) -> float:
    """What a bristle ``d`` points within an edge bears until that has gone one point past it, in points.

    The last two bear all of their cell up to the edge along a line, so one beyond the edge bears (1 + d)^2/2 still, and
    one within it 1/2 + d - d^2/2, of which this is the integral.
    """
    if d >= 1:
        return d
    return 1 / 6 + d / 2 + d * d / 2 - d**3 / 6 if d >= 0 else max(1 + d, 0.0) ** 3 / 6


@loop
def _lags(d: float) -> float:
    """How many points farther than to the edge one goes, weighed by what it bears."""
    if d >= 1 or d <= -1:
        return 0.0
    return _borne(d) / (0.5 + d - d * d / 2 if d >= 0 else (1 + d) ** 2 / 2) - d


@loop
def _of_those_on_the_edge(
    points: Any, bears: tuple[int, int], pull: Any, carried: Any, side: int, edges: tuple[Edge, Edge], spring: float
) -> float:
    """Work of those that an edge has reached, and not left: they bore more until it came than trapezoids have."""
    began, ends = edges
    work, recedes = 0.0, began.place - ends.place
    i = bears[1] if side > 0 else bears[0]
    while recedes > 0 and bears[0] <= i <= bears[1] and ends.place - side * points.number[i] < 1:
        if carried.pull[i] != 0:
            place = side * points.number[i]
            bore = spring * (_borne(began.place - place) - _borne(ends.place - place)) / recedes
            mean = carried.stretch[i] - carried.way[i] / 2
            work -= ((pull[i] + carried.pull[i]) / 2 + bore * mean) * (carried.way[i] - carried.mean[i])
        i -= side
    return work


@loop
def work_of_those_let_go(
    points: Any,
    bears: tuple[int, int],
    pull: Any,
    carried: Any,
    bristles: Bristles,
    slip: Slip,
    ratio: float,
    spring: float,
) -> float:
    """The same where all of a patch sticks: a point that leaves lets go of what the bristles at the edge are stretched
    by as it does, between that when the step began and now. ``bears`` are the first and the last that bear.

    No other way of its own is asked for: beyond the edge the rim is held no more, and moves along the floor by many
    times what bristles are stretched by. In a step that turns by more than the patch is long points come and go. The
    patch's mean way is the parabola in time that those which enter go along.
    """
    number, last = bristles.number, bristles.number.shape[0] - 1
    work, bend = 0.0, slip.way - ratio * (slip.way - slip.way_0)
    if last < 0:
        return work
    for side in (1, -1):
        end, first = (last, 0) if side > 0 else (0, last)
        edge = points.number[bears[1] if side > 0 else bears[0]]
        gone = side * (number[end] - edge)
        if gone <= 0:
            continue
        began = _edge_of(number, bristles.stretch, bristles.pull, side, spring)
        ends = _edge_of(points.number, carried.stretch, pull, side, spring)
        work += _of_those_on_the_edge(points, bears, pull, carried, side, (began, ends), spring)
        grows, recedes = ends.stretch - began.stretch, began.place - ends.place
        for i in range(number.shape[0]):
            stretch = bristles.stretch[i]
            if side * (number[i] - edge) <= 0 or stretch == 0:
                continue
            within = began.place - side * number[i]
            lags = _lags(within)
            share = min(max((within + lags) / recedes, 0.0), 1.0) if recedes > 0 else 0.5
            left = began.stretch + share * grows + lags * began.slope
            pulled = bristles.pull[i] * (1 + left / stretch) / 2
            work += pulled * (left - stretch - share * (slip.way + (1 - share) * bend))
        passed = side * (number[first] - edge) - 1  # points between: they came and went
        for k in range(max(passed, 0)):
            left = began.stretch + (gone - k - 0.5) / gone * grows
            work -= spring * left / 2 * (left - (gone - passed) / gone * slip.way)
    return work
