"""The fields of a flexible motion as a PVD series: ring, rim, disk and floor at chosen instants.

::

    motion = simulate(scene, history=True)
    write_fields(motion, "out")

Instants between two steps are not interpolated: the march takes one more, shorter step to each, so the ring is in
equilibrium with the contact in every frame. Between the pulses the hoop is rigid, and frames there show it undeformed.

``displacement``, ``velocity`` and ``stress`` (xx, yy, xy) are along the world's axes, x to the right and y up;
``hoop_stress`` and ``bending_stress`` along the wall, as a ring that bends far (chain, exact) has turned it. On the
block ``rim`` are ``pressure`` and ``traction``, the vertical and the horizontal force of the floor on the undeformed
rim, and ``stick``: 1 where a point of the rim sticks, -1 where it slips, 0 where it is off the floor. A rigid hoop
touches in a point and has no patch: in its frames all three are 0, also while it is on the floor; its N and F are in
``history.npz``. The displacement of ``rim`` is that of the contact: on a wall that is not thin it differs from that of
``ring``, whose mesh knows no dent narrower than an element.

Units are the scene's. Stresses, pressures and energy densities are those of the ring's ``section_width``; where a scene
says none, of a hoop of width R, and R/b times as large for another of width b.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from math import floor, log10
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes import (
    Block,
    Frame,
    Placement,
    SeriesError,
    SeriesWriter,
    bending_stress,
    disk_block,
    floor_block,
    hoop_stress,
    ring_block,
    von_mises,
)
from meshes.draw.scales import tidy
from meshes.draw.style import SI_UNITS, UNITS, unit
from meshes.placing import around, disk_in
from rigid import Scene

from ..models.select import ring_for
from ..motion import FlexibleMotion
from .curves import curves
from .instants import Instant, instants_at, times_of
from .interior import interior_of
from .recovery import Interior
from .rim import RIM_FIELDS, given_by, rim_of

Array = NDArray[np.float64]

#: what is known of the ring, at its nodes; with the energy density comes the energy of every element
RING_FIELDS = (
    "displacement",
    "velocity",
    "stress",
    "von_mises",
    "hoop_stress",
    "bending_stress",
    "energy_density",
)
#: everything that can be asked for
FIELDS = RING_FIELDS + RIM_FIELDS

_TOGETHER = 50  # frames that are computed at once


def write_fields(
    motion: FlexibleMotion,
    directory: str | Path,
    frames: int = 200,
    times: ArrayLike | None = None,
    fields: str | Sequence[str] = FIELDS,
    pulse: int | None = 0,
    progress: Callable[[float], None] | None = None,
) -> None:
    """Write a motion's fields as ``directory/fields.pvd`` and its frames.

    Parameters
    ----------
    motion : FlexibleMotion
        Of ``simulate(scene, history=True)``.
    directory : path
        Created if need be; a series that is already there is replaced.
    frames : int
        Number of frames, at least 2, through a pulse and a little before and after, denser where N changes, at steps of
        the march where there are as many.
    times : array_like, optional
        The instants themselves, in the scene's unit of time, in place of that. A frame between two steps is of a
        shorter step from the first, which rings with what the longer damps: N of it can be some percent off its curve.
    fields : sequence of str
        One, or several, of those that are there by default, which are all; what is not asked for is not computed.
        Axes, signs and units: :mod:`flexible.output.fields`.
    pulse : int or None
        Number of the pulse, from 0; None, or no pulse at all, spreads the frames over the whole motion.
    progress : callable, optional
        Called with the fraction done, 0 to 1.

    Raises
    ------
    SeriesError
        No flexible motion, no states in it, no such pulse, field or time, or a folder that cannot be written to.
    """
    named = fields if isinstance(fields, Iterable) and not isinstance(fields, str) else (fields,)
    asked = tuple(dict.fromkeys(named if fields is not None else ()))
    unknown = [str(name) for name in asked if name not in FIELDS]
    if unknown or not asked:
        raise SeriesError(f"fields = {', '.join(unknown) or 'none'} is not possible: they are {', '.join(FIELDS)}.")
    if not isinstance(motion, FlexibleMotion):
        raise SeriesError("fields are of a flexible motion: flexible.simulate(scene, history=True) makes one.")
    if not motion.kept and (motion.history is None or motion.marches):
        raise SeriesError("the motion kept no states of the ring: simulate(scene, history=True) does.")
    when = times_of(motion, frames, times, pulse)
    scene = motion.scene
    si = not scene.dimensionless
    instants = instants_at(motion, when)
    painter = _Painter(scene, asked, instants)
    units = SI_UNITS if si else UNITS
    if si and scene.ring.section_width is None:
        units = units | {kind: f"{units[kind]} (b = R)" for kind in ("stress", "energy_density")}
    units = units | {name: unit(name, units) for name in FIELDS} | {"strain_energy": "J" if si else "m g R"}
    units["theta"] = "rad"  # from the disk
    with SeriesWriter(directory, units, _title(scene)) as writer:
        writer.history(**curves(motion, float(when[0]), float(when[-1])))
        for start in range(0, len(instants), _TOGETHER):
            for frame in painter.frames(instants[start : start + _TOGETHER]):
                writer.add(frame)
            if progress is not None:
                progress(min(1.0, (start + _TOGETHER) / len(instants)))


def _title(scene: Scene) -> str:
    hoop, friction = scene.hoop, scene.friction
    return (
        f"k = {hoop.k:g}, r = {hoop.r:g}, m_h/m = {hoop.mass_ratio:g}, "
        f"μ_s = {friction.mu_s:g}, μ = {friction.mu:g}, "
        f"EI = {_short(scene.ring.bending_stiffness)} m g R², ε_n = {_short(scene.contact.stiffness)} m g/R²"
    )


def _short(value: float) -> str:
    """1e4 as 10⁴."""
    exponent = floor(log10(value) + 1e-9)
    if -3 < exponent < 4:
        return f"{value:.4g}"
    mantissa = f"{value / 10.0**exponent:.3g}"
    power = "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return power if mantissa == "1" else f"{mantissa}·{power}"


class _Painter:
    """Instants to frames, in the units of the scene."""

    def __init__(self, scene: Scene, asked: tuple[str, ...], instants: list[Instant]) -> None:
        self.scene, self.asked = scene, set(asked)
        self.interiors = {id(i.kept): interior_of(i.kept.hoop) for i in instants if i.kept is not None}
        hoop = scene.hoop
        self.length = hoop.R
        self.stress = hoop.m * hoop.g / hoop.R**2 / (scene.ring.section_width or 1.0)
        x = [i.place.x_C for i in instants]
        R = self.length
        self.floor = floor_block((min(x) - 2) * R, (max(x) + 2) * R, 0.1 * R)
        known = [interior.mesh for interior in self.interiors.values()]
        self.mesh = known[0] if known else ring_for(scene.to_dimensionless()).mesh
        self.factor = np.array([self._display_factor(instants)])

    def frames(self, instants: list[Instant]) -> Iterator[Frame]:
        """Frames of some instants, those of one segment done at once."""
        done: dict[int, dict[str, Array]] = {}
        for key in dict.fromkeys(id(i.kept) for i in instants if i.kept is not None):
            own = [i for i in instants if id(i.kept) == key]
            done.update(zip((id(i) for i in own), self._ring_fields(self.interiors[key], own), strict=True))
        for instant in instants:
            yield self._frame(instant, done.get(id(instant)))

    def _ring_fields(self, interior: Interior, instants: list[Instant]) -> Iterator[dict[str, Array]]:
        """Nodal fields in the disk's frame, those that were asked for."""
        states = [i.state for i in instants if i.state is not None]
        u = interior.displacement(states)
        found: dict[str, Array] = {"u": u}
        if "velocity" in self.asked:
            before = [i.before for i in instants if i.before is not None]
            after = [i.after for i in instants if i.after is not None]
            found["rate"] = interior.rate(states, before, after)
        if self.asked & {"stress", "von_mises", "hoop_stress", "bending_stress", "energy_density"}:
            found["stress"], found["density"], found["along"] = interior.stress(interior.strained(states))
            if "energy_density" in self.asked:
                found["energy"] = interior.element_energy(u)
        for number in range(len(instants)):
            yield {name: values[..., number] for name, values in found.items()}

    def _frame(self, instant: Instant, found: dict[str, Array] | None) -> Frame:
        mesh, place, R = self.mesh, instant.place, self.length
        count = len(mesh.points)
        if found is None:
            found = {"u": np.zeros((count, 2)), "rate": np.zeros((count, 2)), "stress": np.zeros((count, 3))}
            found["along"] = around(mesh)
            found |= {"density": np.zeros(count), "energy": np.zeros(len(mesh.quad9))}
        points = R * place.points(mesh.points)
        nodal: dict[str, Array] = {}
        if "displacement" in self.asked:
            nodal["displacement"] = R * place.vectors(found["u"])
        if "velocity" in self.asked:
            moving = place.velocities(mesh.points, found["u"], found["rate"], instant.velocity_C, instant.omega)
            nodal["velocity"] = moving * self.scene.velocity_unit
        if "stress" in found:
            nodal |= self._stresses(place, self.stress * found["stress"], found["along"])
        ring = ring_block(mesh, points, **nodal)
        if "energy_density" in self.asked:
            ring = _with_energy(ring, self.stress * found["density"], self.scene.energy_unit * found["energy"])
        ring = replace(ring, field_data={"display_factor": self.factor})
        blocks = {"ring": ring}
        if self.asked & set(RIM_FIELDS):
            kept, state = instant.kept, instant.state
            contact = None if kept is None or state is None else (kept.hoop, state)
            on_rim: dict[str, Array] = {n: nodal[n] for n in ("displacement", "velocity") if n in nodal}
            if contact is not None and "displacement" in nodal:
                u = np.array(found["u"])
                u[mesh.rim_nodes] -= self.interiors[id(kept)].dent(contact[1], given_by(contact[0]))
                on_rim["displacement"] = R * place.vectors(u)
            blocks["rim"] = rim_of(mesh, points, on_rim, contact, place, self.asked, self.stress, R)
        away, radius = disk_in(self.scene)
        centre = R * place.points(np.array([[away, 0.0]]))[0]
        blocks |= {"disk": disk_block(centre, R * radius, place.phi), "floor": self.floor}
        return Frame(instant.t, blocks)

    def _stresses(self, place: Placement, stress: Array, along: Array) -> dict[str, Array]:
        made: dict[str, Array] = {}
        if "stress" in self.asked:
            made["stress"] = place.stress(stress)
        if "von_mises" in self.asked:
            made["von_mises"] = von_mises(stress)
        if self.asked & {"hoop_stress", "bending_stress"}:
            hoop = hoop_stress(self.mesh, stress, along)
            both = {"hoop_stress": hoop, "bending_stress": bending_stress(self.mesh, hoop)}
            made |= {name: value for name, value in both.items() if name in self.asked}
        return made

    def _display_factor(self, instants: list[Instant]) -> float:
        """What makes the largest displacement 2.4 to 6 % of R in pictures; 1 where it is more."""
        elastic = [i for i in instants if i.state is not None]
        some = elastic[:: max(1, len(elastic) // 30)]
        largest = 0.0
        for key, interior in self.interiors.items():
            states = [i.state for i in some if id(i.kept) == key and i.state is not None]
            if states:
                u = interior.displacement(states)
                largest = max(largest, float(np.sqrt((u**2).sum(axis=1)).max()))
        return tidy(0.06 / largest) if largest > 0 else 1.0


def _with_energy(ring: Block, density: Array, energy: Array) -> Block:
    points: dict[str, Any] = {**ring.point_data, "energy_density": density}
    return replace(ring, point_data=points, cell_data={"strain_energy": energy})


__all__ = ["FIELDS", "RING_FIELDS", "write_fields"]
