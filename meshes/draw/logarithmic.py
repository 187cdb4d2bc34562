"""Axes of forces that are linear about zero and logarithmic beyond the usual force."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import style

Array = NDArray[np.float64]


def logarithmic(axes: Any, usual: float, low: float, high: float, size: float) -> None:
    """Make an axis of forces from ``low`` to ``high`` one; labels are 0.85 ``size`` points high.

    Powers of ten have numbers. Between them every multiple has a stroke, and 2 and 5 times a power a number too where
    there is room for it.
    """
    axes.set_yscale("asinh", linear_width=usual)
    room = 0.3 * usual
    axes.set_ylim(3 * low if low < -usual else low - room, 3 * high if high > usual else high + room)
    decades = 10.0 ** np.arange(np.ceil(np.log10(usual)), np.ceil(np.log10(max(high, -low, 2 * usual))))
    some = decades[:: -max(1, len(decades) // 3)][:3]
    if len(some) > 2:  # beside two others one at the usual force would lie over the zero
        some = some[some > 2 * usual]
    above = decades[decades <= high][-1:] if low < -usual else some[some <= high]
    powers = np.sort([*-decades[decades <= -low][-1:], 0.0, *above])
    axes.set_yticks(powers, minor=False)
    axes.yaxis.set_major_formatter(lambda value, _: _decade(value))
    strokes = _between(usual, *axes.get_ylim())
    axes.set_yticks(strokes, minor=True)
    height = axes.get_position().height * axes.figure.get_figheight() * 72
    numbered = _with_room(strokes, powers, 0.95 * size / height, axes)
    axes.yaxis.set_minor_formatter(lambda value, _: _decade(value) if value in numbered else "")
    axes.tick_params(which="minor", labelsize=0.7 * size, length=2, color=style.FAINT, labelcolor=style.INK)
    axes.text(0.01, 0.98, "log", transform=axes.transAxes, va="top", color=style.FAINT, fontsize=0.8 * size)


def _between(usual: float, low: float, high: float) -> Array:
    """Whole multiples of powers of ten, from the usual force on to the ends of the axis, both ways."""
    powers = 10.0 ** np.arange(np.floor(np.log10(usual)), np.ceil(np.log10(max(high, -low))))
    multiples = np.outer(powers, np.arange(1, 10)).ravel()
    multiples = multiples[multiples >= (1 - 1e-9) * usual]
    return np.concatenate([-multiples[multiples <= -low][::-1], multiples[multiples <= high]])


def _with_room(strokes: Array, powers: Array, apart: float, axes: Any) -> set[float]:
    """Those whose numbers stand so far apart, as a share of the axis: powers of ten first, then 5 and 2 times these."""

    def place(value: float) -> float:
        return float(axes.transLimits.transform(axes.transScale.transform((0.0, value)))[1])

    taken, chosen = [place(value) for value in powers], set()
    for digit in (1, 5, 2):
        for value in strokes[::-1]:
            first = abs(value) / 10.0 ** np.floor(np.log10(abs(value)) + 1e-9)
            at = place(value)
            if abs(first - digit) < 1e-6 and all(abs(at - other) >= apart for other in (*taken, 0.0, 1.0)):
                taken.append(at)
                chosen.add(float(value))
    return chosen


def _decade(value: float) -> str:
    """A power of ten of either sign, or a multiple of one, as an axis prints it."""
    if abs(value) < 1e4:
        return f"{value:g}"
    sign, power = "-" if value < 0 else "", int(np.floor(np.log10(abs(value)) + 1e-9))
    times = round(abs(value) / 10.0**power)
    many = "" if times == 1 else f"{times}·"
    return f"${sign}{many}10^{{{power}}}$"
