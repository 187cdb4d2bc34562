"""`hoop bench contact`: what is no error of the mesh in flexible/README, section 4, found anew.

The same pulse with its contact points in other places, what the books leave unexplained, the friction force of a hoop
that rolls at the end of each step beside that of the rigid one, and how steps grow as the tolerance gets finer.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import nan
from typing import Any

import numpy as np

import flexible
from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene, Solve

from ..inner.march.body import body_of, rolling_forces
from .knobs import Setting, pulse_at
from .race import Claim, Result, Row
from .truth.reference import errors, massless_brush, massless_pulse

SOLVER = "hoop-pulse"
AVERAGE = "on average [m g]"
PLACES = (1.0, 1.01, 1.02, 1.03, 1.04, 1.05)  # of the number of points: they lie anywhere in the patch
SCATTER = ("J_F/J_N", "loss", "N_max")
MOST_SCATTER = 0.5  # of it over rtol
BOOKS, FORCE, STEPS = "left by the books, over rtol", "F off, at most [N]", "steps"
MOST_LEFT = {"thin": 0.1, "thick": 1.0}
MOST_OFF = 1.5e-3  # of F over N, where the floor gives way by more than the ring
MOST_GROWTH = 10.0  # of the steps from 1e-4 to 1e-6

Job = tuple[str, Scene, tuple[float, ...]]


def scattered(quick: bool) -> Iterator[Job]:
    """Massless pulses whose points are moved."""
    for scene in (massless_pulse(), massless_brush()):
        for damping in (1.0,) if quick else (1.0, 0.2):
            name = f"massless, {scene.contact.law}, damping {damping:g}"
            yield name, scene.replace(contact={"damping": damping}), (1e-3, 1e-4, 1e-5, 1e-6)[: 2 if quick else 4]


def booked(quick: bool) -> Iterator[Job]:
    """First pulses from rest in thin walls and thick ones."""
    kinds = (
        ("thin", 0.0, 1.02, 1e4, 1e9), ("thin", 0.0, 1.02, 1e3, 1e8), ("thin", 0.1, 1.02, 1e4, 1e9),
        ("thin", 0.1, 1.02, 65.0, 1e7), ("thin", 0.05, 1.02, 10.0, 1e8), ("thick", 0.1, 1.2, 1e4, 1e9),
        ("thick", 0.1, 1.2, 65.0, 1e7), ("thick", 0.1, 1.2, 65.0, 1e9),
    )  # fmt: skip
    for wall, mass, r, bending, foundation in kinds[:2] if quick else kinds:
        name = f"{wall}, m_h/m = {mass:g}, r = {r:g}, E I = {bending:g} on {foundation:g}"
        scene = _hoop(Hoop(k=0.1, r=r, mass_ratio=mass), Friction(0.35, 0.3), 10, bending, foundation)
        yield name, scene, (1e-3, 1e-4, 1e-5)


def rolled(quick: bool) -> Iterator[Job]:
    """Hoops of heavy walls that roll through their pulse, with steps longer than the patch."""
    for r, bending, foundation in ((1.3, 500.0, 1e7), (1.5, 500.0, 1e7), (1.1, 100.0, 1e7), (1.3, 50.0, 1e7)):
        name = f"rolls, r = {r:g}, E I = {bending:g} on {foundation:g}"
        yield name, _hoop(Hoop(k=0.6, r=r, mass_ratio=2.0), Friction(0.2, 0.2), 40, bending, foundation), (1e-3, 1e-4)
        if quick:
            return


def grown(quick: bool) -> Iterator[Job]:
    """Pulses on stiffer and stiffer floors: massless, of ever stiffer rings; and of one ring, without mass and with."""
    masses = (0.05,) if quick else (0.0, 0.05, 0.2)
    for scene in (massless_pulse(), massless_brush()):
        for foundation in (1e10,) if quick else (1e8, 1e10, 1e12):
            kinds = [("massless", 0.0, 1e-5 * foundation), *((f"m_h/m = {mass:g}", mass, 1e4) for mass in masses)]
            for what, mass, bending in kinds:
                stiff = scene.replace(hoop={"mass_ratio": mass}, contact={"stiffness": foundation})
                name = f"{what}, {scene.contact.law}, E I = {bending:g} on {foundation:g}"
                yield name, stiff.replace(ring={"bending_stiffness": bending}), (1e-4, 1e-6)


def _hoop(hoop: Hoop, friction: Friction, degrees: float, bending: float, foundation: float) -> Scene:
    ring, contact = Ring(bending_stiffness=bending), Contact(stiffness=foundation)
    return Scene(hoop, friction, Release(phi0_deg=degrees), Run(until="pulse"), ring=ring, contact=contact)


def scatter(scene: Scene, rtol: float) -> tuple[float, dict[str, float]]:
    """Largest less smallest of pulses with points in other places, the largest force's relative; the worst over J_N."""
    chosen = Setting.of(scene, rtol)
    found = [pulse_at(scene, replace(chosen, points=by * chosen.points)) for by in PLACES]
    seen = [(one.friction_impulse / one.normal_impulse, one.friction_loss, one.peak_normal_force) for one in found]
    spread = np.ptp(seen, axis=0)
    spread[2] /= seen[0][2]
    worst = max(errors(one, other)[0] for one in found for other in found)
    return worst, dict(zip(SCATTER, map(float, spread), strict=True))


def left_by_books(scene: Scene, rtol: float) -> dict[str, float]:
    """The residual over rtol times the energy at the release, and the steps."""
    motion = _run(scene, rtol)
    return {BOOKS: motion.ledger.residual / motion.ledger.initial / rtol, STEPS: float(motion.steps)}


def force_of_rolling(scene: Scene, rtol: float) -> dict[str, float]:
    """What F of each step's end is off that of the rigid hoop at its angle and speed, about the middle of the pulse."""
    motion = _run(scene, rtol)
    seen, pulse, total = motion.history, motion.pulses[0], 1 + scene.hoop.mass_ratio
    half = (pulse.t_end - pulse.t_start) / 2
    inside = np.abs(seen.t - pulse.t_start - half) < 0.8 * half  # where no hand-over rings
    body, psi = body_of(scene.hoop), seen.phi[inside] - np.pi
    rigid = [rolling_forces(body, *at)[1] for at in zip(psi, seen.omega[inside], strict=True)]
    off = seen.friction_force[inside] - total * np.array(rigid)
    most = float(np.abs(off / seen.normal_force[inside]).max())
    return {FORCE: most, AVERAGE: float(np.abs(off.mean())), STEPS: float(motion.steps)}


def _run(scene: Scene, rtol: float) -> Any:
    motion = flexible.simulate(scene.replace(solve=Solve(rtol=rtol)), history=True)
    if not motion.completed:
        raise RuntimeError(motion.ended)
    return motion


def bench(quick: bool = False, peers_too: bool = False, progress: Callable[[float], None] | None = None) -> Result:
    """All of it, and what is stated of it."""
    kinds: list[tuple[Callable[[Scene, float], Any], list[Job]]] = [
        (scatter, list(scattered(quick))),
        (left_by_books, list(booked(quick))),
        (force_of_rolling, list(rolled(quick))),
        (lambda scene, rtol: {STEPS: float(_run(scene, rtol).steps)}, list(grown(quick))),
    ]
    result = Result(parts=SCATTER, told={"What the books leave": (BOOKS, STEPS)})
    result.told |= {"F at an instant": (FORCE, AVERAGE, STEPS), "Steps by tolerance": ("growth", STEPS)}
    jobs = [(measure, name, scene, rtol) for measure, of in kinds for name, scene, rtols in of for rtol in rtols]
    for number, (measure, name, scene, rtol) in enumerate(jobs):
        row = Row(SOLVER, f"rtol {rtol:.0e}", name, [])
        result.rows.append(row)
        start = time.process_time()
        try:
            found = measure(scene, rtol)
        except RuntimeError as trouble:
            row.note = str(trouble)
        else:
            row.seconds.append(time.process_time() - start)
            row.error, row.more = found if measure is scatter else (row.error, found)
            row.more["rtol"] = rtol
        if progress is not None:
            progress((number + 1) / len(jobs))
    _compare_steps(result.rows, [name for name, *_ in kinds[-1][1]])
    result.claims = list(_claims(result.rows))
    return result


def _compare_steps(rows: list[Row], names: list[str]) -> None:
    """Note how many times the steps of its coarsest tolerance a run takes."""
    for name in names:
        mine = [row for row in rows if row.scene == name and STEPS in row.more]
        for row in mine:
            row.more["growth"] = row.more[STEPS] / mine[0].more[STEPS]


def _claims(rows: list[Row]) -> Iterator[Claim]:
    moved = [row.error / row.more["rtol"] for row in rows if SCATTER[0] in row.more]
    yield Claim(
        "points in other places: what that changes, over rtol", max(moved, default=nan), MOST_SCATTER, at_most=True
    )
    for wall, most in MOST_LEFT.items():
        left = [abs(row.more[BOOKS]) for row in rows if BOOKS in row.more and row.scene.startswith(wall)]
        if left:
            yield Claim(f"{wall} walls: what the books leave, over rtol", max(left), most, at_most=True)
    off = [row.more[FORCE] for row in rows if FORCE in row.more and "E I = 50 " not in row.scene]
    yield Claim("rolling in thick walls: F off, over N", max(off, default=nan), MOST_OFF, at_most=True)
    steps = [row.more["growth"] for row in rows if "growth" in row.more]
    yield Claim("steps at rtol 1e-6, over those at 1e-4", max(steps, default=nan), MOST_GROWTH, at_most=True)
