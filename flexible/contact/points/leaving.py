"""What bristles do between the beginning of a step and where in it their points left the floor."""

from __future__ import annotations

from math import pi
from typing import Any

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
    """Whether none of the points that bear on the floor slides."""
    slide = 0
    for i in range(weight.shape[0]):
        slide += 1 if weight[i] > 0 and abs(sliding[i]) == 1 else 0
    return slide == 0


@loop
def _stretch_before(bristles: Bristles, end: int, onward: int) -> float:
    """Stretch at an edge of a patch when the step began: of its last two bristles, by what they bear of the floor."""
    bears, stretched, i = 0.0, 0.0, end
    for _ in range(2):
        if 0 <= i < bristles.number.shape[0] and bristles.stretch[i] != 0:
            bears -= bristles.pull[i] / bristles.stretch[i]
            stretched -= bristles.pull[i]
        i += onward
    return stretched / bears if bears > 0 else 0.0


@loop
def _stretch_now(weight: Any, stretch: Any, end: int, onward: int, otherwise: float) -> float:
    """The same at its end, of those that bear."""
    bears, stretched, i, left = 0.0, 0.0, end, 2
    while left > 0 and 0 <= i < weight.shape[0]:
        if weight[i] > 0:
            bears += weight[i]
            stretched += weight[i] * stretch[i]
            left -= 1
        i += onward
    return stretched / bears if bears > 0 else otherwise


@loop
def work_of_those_let_go(points: Any, weight: Any, stretch: Any, before: Before, way: float, law: Parameters) -> float:
    """The same where all of a patch sticks: a point that leaves lets go of what the bristles at the edge are stretched
    by as it does, between that when the step began and now.

    No other way of its own is asked for: beyond the edge the rim is held no more, and moves along the floor by many
    times what bristles are stretched by. In a step that turns by more than the patch is long points come and go.
    """
    bristles = before.bristles
    number, last = bristles.number, bristles.number.shape[0] - 1
    work = 0.0
    if last < 0:
        return work
    low, high = points.number[0], points.number[-1]
    for side in (1, -1):
        end, first = (last, 0) if side > 0 else (0, last)
        edge = high if side > 0 else low
        gone = side * (number[end] - edge)
        if gone <= 0:
            continue
        began = _stretch_before(bristles, end, -side)
        ends = _stretch_now(weight, stretch, weight.shape[0] - 1 if side > 0 else 0, -side, began)
        for i in range(number.shape[0]):
            past = side * (number[i] - edge)
            if past <= 0 or bristles.stretch[i] == 0:
                continue
            share = (gone - past + 0.5) / gone
            spring = -bristles.pull[i] / bristles.stretch[i]
            left = began + share * (ends - began)
            work -= spring * (left + bristles.stretch[i]) / 2 * (left - bristles.stretch[i] - share * way)
        passed = side * (number[first] - edge) - 1  # points between: they came and went
        for k in range(max(passed, 0)):
            left = began + (gone - k - 0.5) / gone * (ends - began)
            work -= law.eps_t * law.spacing * left / 2 * (left - (gone - passed) / gone * way)
    return work
