"""Curves of a motion over time or angle, in matplotlib."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import sampling
from .units import Unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

_WORDS = {
    "t": ("time", "$t$", Unit.TIME),
    "phi": ("angle", r"$\varphi$", Unit.NUMBER),
    "omega": ("angular velocity", r"$\dot\varphi$", Unit.ANGULAR_VELOCITY),
    "alpha": ("angular acceleration", r"$\ddot\varphi$", Unit.ANGULAR_ACCELERATION),
    "x_C": ("way of the centre", "$x_C$", Unit.LENGTH),
    "y_C": ("height of the centre", "$y_C$", Unit.LENGTH),
    "slip_velocity": ("slip velocity", "$v$", Unit.VELOCITY),
    "normal_force": ("normal force", "$N$", Unit.FORCE),
    "friction_force": ("friction force", "$F$", Unit.FORCE),
    "energy": ("energy", "$E$", Unit.ENERGY),
}
"""Name, symbol and unit of everything that a state has."""

_SHADES = {"spin": "#cfe3f3", "skid": "#fbe0cd", "flight": "#e6e6e6", "skim": "#e3efd6"}
"""Behind the phases in which the contact point does not roll."""

MOST_SHADES = 200  # more phases than this are not shaded: nobody could see them

_BAND = 9.0  # points, of a shade that goes along its curve

Span = tuple[str, float, float]
"""A kind of phase and the times at which it begins and ends."""


def label(name: str, dimensionless: bool) -> str:
    """What an axis is called, and its unit: the paper's scaling, or SI units."""
    words, symbol, unit = _WORDS[name]
    if name == "phi":
        return f"{words} {symbol} (rad)"
    return f"{words} {symbol[:-1]}/{_grouped(unit.formula)}$" if dimensionless else f"{words} {symbol} ({unit.si})"


def _grouped(unit: str) -> str:
    return unit if unit.startswith("\\") or len(unit) == 1 else f"({unit})"


def columns_of(states: Any) -> dict[str, Array]:
    """What a record of arrays has, by name."""
    return {entry.name: getattr(states, entry.name) for entry in dataclasses.fields(states)}


def check(names: Iterable[str]) -> None:
    """Refuse what no state has.

    Raises
    ------
    ValueError
        One sentence with all names there are.
    """
    for name in names:
        if not isinstance(name, str) or name not in _WORDS:
            raise ValueError(f"{name!r} is not a quantity of a motion: known are {', '.join(_WORDS)}.")


def of_motion(motion: Any, quantities: Sequence[str], over: str, axes: Any) -> NDArray[np.object_]:
    """Curves of a whole motion, its phases shaded; see :meth:`rigid.Motion.plot`."""
    phases = motion.phases[: MOST_SHADES + 1]
    spans = [(str(phase.kind), phase.t_start, phase.t_end) for phase in phases] if len(phases) <= MOST_SHADES else []
    columns = columns_of(motion.at(motion.times()))
    return draw(columns, quantities, over, dimensionless=motion.scene.dimensionless, spans=spans, axes=axes)


def of_pulse(pulse: Any, quantities: Sequence[str], over: str, axes: Any) -> NDArray[np.object_]:
    """Curves of a motion through one of its pulses; see :meth:`rigid.Pulse.plot`."""
    sample = pulse.sample
    if sample is None:
        raise ValueError("This pulse belongs to no motion that could be sampled.")
    span = (pulse.t_start, pulse.t_end)
    middle = sampling.bottom(lambda t: sample(t, "right").phi, *span)
    steps = sampling.steps_of(sample)
    t = sampling.times(lambda t: sampling.forces_of(sample(t, "right")), span, [middle], steps=steps)
    paper = getattr(getattr(sample, "scene", None), "dimensionless", True)
    return draw(columns_of(sample(t, "right")), quantities, over, dimensionless=paper, axes=axes)


def draw(
    columns: Mapping[str, Array],
    quantities: Sequence[str],
    over: str,
    *,
    dimensionless: bool,
    spans: Sequence[Span] = (),
    axes: Any = None,
) -> NDArray[np.object_]:
    """One panel below the other, a quantity each.

    Parameters
    ----------
    columns : mapping
        Arrays (n,) by name, ``t`` of them ascending.
    quantities : sequence of str
        What is drawn; N, F and slip velocity if nothing is named.
    over : str
        The abscissa, usually "t" or "phi".
    dimensionless : bool
        Whether the numbers are in the paper's scaling, which the labels then say.
    spans : sequence
        Phases, of which those that do not roll are shaded.
    axes : matplotlib Axes or sequence of them, optional
        Where to draw; as many as there are quantities. On a figure of its own shades have a legend above the panels.

    Returns
    -------
    (n,) array of matplotlib Axes
    """
    quantities = quantities or ("normal_force", "friction_force", "slip_velocity")
    check([*quantities, over])
    panels: list[Axes]
    if axes is None:
        from matplotlib import pyplot

        figure, made = pyplot.subplots(
            len(quantities), sharex=True, squeeze=False, figsize=(7, 1.2 + 1.8 * len(quantities)), layout="constrained"
        )
        panels = list(made[:, 0])
    else:
        panels = list(np.atleast_1d(axes).ravel())
        if len(panels) != len(quantities):
            raise ValueError(f"{len(quantities)} quantities need as many axes, not {len(panels)}.")
        for panel in panels:
            if not hasattr(panel, "axvspan"):
                raise ValueError(f"{type(panel).__name__} is not possible: what is drawn on are matplotlib Axes.")
    for panel, name in zip(panels, quantities, strict=True):
        _shade(panel, columns, name, over, [span for span in spans if span[0] in _SHADES and span[1] < span[2]])
        panel.plot(columns[over], columns[name], linewidth=1.2)
        panel.set_ylabel(label(name, dimensionless))
    panels[-1].set_xlabel(label(over, dimensionless))
    handles, words = panels[0].get_legend_handles_labels()
    if axes is None and handles:
        figure.legend(handles, words, loc="outside upper right", ncols=len(words), frameon=False, fontsize="small")
    return np.array(panels, dtype=object)


def _shade(panel: Axes, columns: Mapping[str, Array], name: str, over: str, spans: Iterable[Span]) -> None:
    """Shade spans, the first of each kind with a label: over time all of the panel's height; elsewhere, where a motion
    may come by again and do something else, along the stretch of the curve.
    """
    told: set[str] = set()
    for kind, start, end in spans:
        look: dict[str, Any] = {"color": _SHADES[kind], "label": "_" if kind in told else kind}
        told.add(kind)
        if over == "t":
            panel.axvspan(start, end, linewidth=0, zorder=0, **look)
            continue
        t = columns["t"]
        own = slice(np.searchsorted(t, start), np.searchsorted(t, end, "right" if end >= t[-1] else "left"))
        panel.plot(columns[over][own], columns[name][own], linewidth=_BAND, solid_capstyle="butt", zorder=1, **look)
