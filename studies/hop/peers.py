"""Hop by hop beside another code: Exudyn's ring of geometrically exact cables, both codes at settings coarse to fine.

Hoops that hop, released at rest in equilibrium, under what both codes have: one coefficient of friction, no damping,
the same springs and bristles, on a floor soft enough for the few segments of a cable.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import nan, radians
from typing import Any, NamedTuple

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from flexible.output.body import lowest
from rigid import Friction, Release, Ring, Run, Scene, scene_to_dict

from ..bench.peers import exudyn_ring
from ..bench.peers.scipy_ivp import installed
from ..bench.truth.reference import scene_b
from ..plots.sheet import Column, Sheet, number
from ..plots.style import OKABE_ITO, STYLE, blank
from .rolling.roll import roll, spans, steps_of
from .rolling.rule import Scales, scales_of

Array = NDArray[np.float64]

OURS, THEIRS = "hoop-pulse", "Exudyn"
RTOLS = (1e-3, 3e-4, 1e-4)
SHOWN = 2
"""Hops of a roll that are told."""


class Cut(NamedTuple):
    """A setting of Exudyn's ring."""

    elements: int
    segments: int
    """Of contact to a cable."""
    step: float

    def __str__(self) -> str:
        return f"{self.elements} cables, {self.elements * self.segments} points, h = {self.step:g}"


CUTS = (Cut(120, 4, 2e-3), Cut(120, 8, 1e-3), Cut(240, 8, 1e-3))
"""The second has twice the points and half the step, the third twice the cables and points."""


def case(bending_stiffness: float, k: float, t_end: float) -> Scene:
    """A hoop of m_h/m = 0.1 from rest at 30 degrees, from where it comes down sooner than from 10.

    Its wall is thin, for cables know nothing of how a weld at the inner rim holds a thick one.
    """
    return scene_b().replace(
        hoop={"k": k, "r": 1.0},
        friction=Friction(0.5, 0.5),
        release=Release(radians(30)),
        run=Run(t_end=t_end),
        ring=Ring(bending_stiffness=bending_stiffness, thickness=0.005),
        contact={"stiffness": 1e6},
        solve={"level": "chain", "start": "equilibrium"},
    )


CASES = (case(6.0, 0.1, 4.82), case(6.0, 0.2, 5.05), case(2.0, 0.3, 4.58))
"""Hops behind the pulse, twice, and under the disk; the end lies behind those that are told."""


class Hop(NamedTuple):
    """A flight that counts as a hop; R = m = g = 1."""

    t: float
    phi: float
    duration: float
    height: float
    """Of the rim's lowest point, the largest."""


@dataclass(frozen=True)
class Rolled:
    """A case as one code rolls it at one setting."""

    scene: Scene
    program: str
    setting: str
    hops: tuple[Hop, ...] = ()
    seconds: float = nan
    """Of CPU."""
    note: str = ""
    """Why there are no hops."""
    track: tuple[Array, Array] | None = None
    """Rotation of the disk, and height of the rim's lowest point, step by step."""

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        told = {name: getattr(self, name) for name in ("program", "setting", "seconds", "note")}
        return {"scene": scene_to_dict(self.scene), **told, "hops": [hop._asdict() for hop in self.hops]}


class Compared(NamedTuple):
    """One quantity of the first hop of a case, each code at its finest."""

    scene: Scene
    quantity: str
    ours: float
    ours_moved: float
    """From the setting before."""
    theirs: float
    theirs_moved: float


def hops_of(t: Array, phi: Array, gap: Array, scales: Scales) -> tuple[Hop, ...]:
    """Hops of a motion told by the gap under its lowest point, by the study's rule; without one that the end cuts.

    A flight begins and ends where the gap, straight between instants, passes 0.
    """
    found = []
    for first, last in spans(gap > 0):
        if first == 0 or last == len(t) - 1:
            continue
        up = gap[first] / (gap[first] - gap[first - 1])
        down = gap[last] / (gap[last] - gap[last + 1])
        start = t[first] - up * (t[first] - t[first - 1])
        angle = phi[first] - up * (phi[first] - phi[first - 1])
        lasts = float(t[last] + down * (t[last + 1] - t[last]) - start)
        height = float(gap[first : last + 1].max())
        if scales.prominence(height, lasts) >= 1:
            found.append(Hop(float(start), float(angle), lasts, height))
    return tuple(found)


def rolls(
    cases: Sequence[Scene],
    cuts: Sequence[Cut] = CUTS,
    rtols: Sequence[float] = RTOLS,
    progress: Callable[[float], None] | None = None,
) -> list[Rolled]:
    """Every case by both codes, coarse to fine; Exudyn says if it is not installed."""
    found: list[Rolled] = []
    for done, scene in enumerate(cases):
        found += [_ours(scene, rtol) for rtol in rtols]
        if not installed("exudyn"):
            found.append(Rolled(scene, THEIRS, "-", note="exudyn is not installed"))
            if progress is not None:
                progress((done + 1) / len(cases))
            continue
        for number_of, cut in enumerate(cuts):
            found.append(_theirs(scene, cut))
            if progress is not None:
                progress((done + (number_of + 1) / len(cuts)) / len(cases))
    return found


def _ours(scene: Scene, rtol: float) -> Rolled:
    start = time.process_time()
    motion = roll(scene.replace(solve={"rtol": rtol}), history=True)
    seconds = time.process_time() - start
    steps = steps_of(motion)
    gap = np.array([lowest(steps.hoop, state) for state in steps.states])
    hops = hops_of(steps.history.t, steps.history.phi, gap, motion.scales)
    note = "" if motion.completed else motion.ended
    return Rolled(scene, OURS, f"rtol = {rtol:g}", hops, seconds, note, (steps.history.phi, gap))


def _theirs(scene: Scene, cut: Cut) -> Rolled:
    start = time.process_time()
    try:
        motion = exudyn_ring.roll(scene, cut.elements, cut.step, cut.segments)
    except RuntimeError as error:  # its own words for not getting there
        return Rolled(scene, THEIRS, str(cut), note=" ".join(str(error).split()))
    seconds = time.process_time() - start
    hops = hops_of(motion.t, motion.phi, motion.gap, scales_of(scene, motion.sag))
    return Rolled(scene, THEIRS, str(cut), hops, seconds, track=(motion.phi, motion.gap))


def compared(found: Sequence[Rolled]) -> list[Compared]:
    """The first hop of each case that both codes have at their two finest settings, quantity by quantity."""
    rows = []
    for scene in dict.fromkeys(each.scene for each in found):
        ours, theirs = (_finest(found, scene, program) for program in (OURS, THEIRS))
        if ours is None or theirs is None:
            continue
        for name in ("phi", "duration", "height"):
            (a, b), (c, d) = (tuple(getattr(hop, name) for hop in pair) for pair in (ours, theirs))
            rows.append(Compared(scene, name, b, b - a, d, d - c))
    return rows


def _finest(found: Sequence[Rolled], scene: Scene, program: str) -> tuple[Hop, Hop] | None:
    """First hops at the setting before the finest, and at the finest."""
    mine = [each for each in found if each.scene == scene and each.program == program][-2:]
    if len(mine) < 2 or not all(each.hops for each in mine):
        return None
    return mine[0].hops[0], mine[1].hops[0]


def title(scene: Scene) -> str:
    """Which case it is."""
    return f"E I = {scene.ring.bending_stiffness:g}, k = {scene.hoop.k:g}"


def peer_sheets(found: Sequence[Rolled]) -> list[Sheet]:
    """All rolls with their hops, and the first hops side by side."""

    def told(name: str, digits: int) -> list[str]:
        return ["\n".join(number(getattr(hop, name), digits) for hop in each.hops[:SHOWN]) or "-" for each in found]

    cells = [title(each.scene) for each in found]
    rules = [i for i in range(1, len(cells)) if cells[i] != cells[i - 1]]
    notes = [each.note for each in found]
    columns = [
        Column("CPU\n[s]", [number(each.seconds, 3) for each in found]),
        Column("t", told("t", 4)),
        Column("φ", told("phi", 4)),
        Column("lasts", told("duration", 3)),
        Column("height", told("height", 3)),
    ]
    if any(notes):
        columns.append(Column("", notes, words=True))
    programs = [f"{each.program}, {each.setting}" if each.setting != "-" else each.program for each in found]
    keys = [Column("hoop", cells, words=True), Column("code", programs, words=True)]
    sheets = [Sheet(f"Hops beside another code, the first {SHOWN} of each roll", keys, columns, rules)]
    rows = compared(found)
    if rows:
        sheets.append(
            Sheet(
                "The first hop, both at their finest; moved: from the setting before",
                [Column("hoop", [title(r.scene) for r in rows], words=True), Column("", [r.quantity for r in rows])],
                [
                    Column(OURS, [number(r.ours, 4) for r in rows]),
                    Column("moved", [number(r.ours_moved, 1) for r in rows], joined=True),
                    Column(THEIRS, [number(r.theirs, 4) for r in rows]),
                    Column("moved", [number(r.theirs_moved, 1) for r in rows], joined=True),
                    Column("apart", [number(r.ours - r.theirs, 1) for r in rows]),
                ],
                list(range(3, len(rows), 3)),
            )
        )
    return sheets


def peers_to_dict(found: Sequence[Rolled]) -> dict[str, Any]:
    """As JSON prints it."""
    first = [row._asdict() | {"scene": title(row.scene)} for row in compared(found)]
    return {"rolls": [each.to_dict() for each in found], "first_hops": first}


def peers_figure(found: Sequence[Rolled]) -> Figure:
    """Height of the rim's lowest point over the rotation of the disk, a panel for each case."""
    cases = list(dict.fromkeys(each.scene for each in found))
    with matplotlib.rc_context(STYLE):
        figure = blank(4.4 * len(cases), 4.4)
        for axes, scene in zip(figure.subplots(1, len(cases), squeeze=False)[0], cases, strict=True):
            mine = [each for each in found if each.scene == scene]
            for program, colour, widest in ((THEIRS, OKABE_ITO["contact_spring"], 3.2), (OURS, "black", 1.2)):
                drawn = [(each.setting, each.track) for each in mine if each.program == program and each.track]
                for i, (setting, (phi, gap)) in enumerate(drawn, 1):
                    axes.plot(phi, gap, color=colour, linewidth=widest * i / len(drawn), label=f"{program}, {setting}")
            starts = [hop.phi for each in mine for hop in each.hops[:SHOWN]]
            if starts:
                end = max(float(each.track[0].max()) for each in mine if each.track)
                axes.set_xlim(min(starts) - 0.15, min(max(starts) + 0.45, end))
            axes.set(xlabel="φ", title=title(scene))
        figure.axes[0].set_ylabel("height of the rim's lowest point / R")
        figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
        return figure
