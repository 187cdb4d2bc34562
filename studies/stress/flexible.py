"""What must hold for any flexible scene."""

from __future__ import annotations

import dataclasses
from math import isfinite, isnan
from typing import Any

import numpy as np

from flexible import FlexibleMotion, simulate
from rigid import Kind, Release, Scene

from .checks import NO, Checked, Margins, apart, impulses, in_si, listed, mirrored
from .work import Work

OUT_OF_RANGE = ("too far for a linear ring", "well above 1.3/k")
_LOOSE = 30.0  # times rtol: what the error control, which works on the impulses step by step, may leave at the end


def _allowed(scene: Scene) -> float:
    return _LOOSE * scene.solve.rtol + 1e-6


def _history(motion: FlexibleMotion) -> Margins:
    """N >= 0, |F| <= mu_s N and finite at every accepted step."""
    steps = motion.history
    assert steps is not None
    if not all(np.isfinite(getattr(steps, field.name)).all() for field in dataclasses.fields(steps)):
        return {"finite": NO}
    if not len(steps.t):
        return {}
    normal, friction = steps.normal_force, steps.friction_force
    most = max(1.0, float(normal.max()))
    bound = motion.scene.friction.mu_s * normal
    margins = {
        "N >= 0": float(-normal.min()) / most / 1e-10,
        "in order": 0.0 if (np.diff(steps.t) >= 0).all() else NO,
    }
    # Newton meets the forces to 1e-9 of the weight, or of themselves; a motion that has left its range says so
    if not any(words in motion.ended for words in OUT_OF_RANGE):
        margins["|F| <= mu_s N"] = float((np.abs(friction) - bound).max()) / (1e-6 * most)
    return margins


def _ledger(motion: FlexibleMotion) -> Margins:
    """The integrals of the ledger explain where the energy went, and no loss is negative."""
    books = motion.ledger
    values = dataclasses.asdict(books)
    if not all(map(isfinite, values.values())):
        return {"finite": NO}
    scale = max(1.0, abs(books.initial), books.kinetic)
    allowed = _allowed(motion.scene) * scale
    return {
        "residual": abs(books.residual) / allowed,
        "numerical loss": abs(books.numerical_loss) / allowed,
        # the bristles of a sliding patch hold mu p before they slip as far; friction gives it to them in advance
        "losses >= 0": -min(books.friction_loss + books.contact_spring, books.landing_loss, books.damping_loss, 0.0)
        / allowed,
    }


def _again(motion: FlexibleMotion, work: Work) -> Margins:
    """Mirrored, in SI units and restarted, each with the work of a run.

    A rerun may take other steps: it agrees as the tolerance promises, not to round-off. A motion that bounces on may
    be so sensitive that no tolerance promises anything: what a release off by the tolerance, a per mille of it or a
    millionth changes, a rerun may change too.
    """
    scene = motion.scene

    def change(other: Scene, units: Any = 1) -> float | None:
        """Of the normal impulse and the friction impulse of the first pulse; None where a run was cut."""
        work.renew()
        again = simulate(other, progress=work, most_steps=work.steps)
        return None if work.cuts(again) else apart(impulses(motion)[:1], impulses(again)[:1] * units)

    si = in_si(scene)
    others: dict[str, tuple[Scene, Any]] = {
        "mirrored": (mirrored(scene), (1, -1)),
        "in SI units": (si, 1 / si.impulse_unit),
    }
    later = _from_the_middle(motion)
    if later is not None:
        others["restarted"] = (later, 1)
    margins = {}
    for name, (other, units) in others.items():
        if (found := change(other, units)) is not None:
            margins[name] = found / _allowed(scene)
    if max(margins.values(), default=0.0) > 1:
        releases = [scene.release.phi0 + share * scene.solve.rtol for share in (1.0, 1e-3, 1e-6)]
        swings = [change(scene.replace(release={"phi0": phi0})) or 0.0 for phi0 in releases]
        margins = {name: margin / (1 + max(swings) / _allowed(scene)) for name, margin in margins.items()}
    return margins


def _from_the_middle(motion: FlexibleMotion) -> Scene | None:
    """The scene released in the middle of the rolling or slipping that the rigid hoop does before the first pulse."""
    scene, first = motion.scene, motion.phases[0]
    start = motion.pulses[0].t_start
    on_floor = (Kind.ROLL, Kind.SKID, Kind.SPIN)
    before = first.t_end < start and all(phase.kind in on_floor for phase in motion.phases if phase.t_start < start)
    if scene.solve.resolve != "pulses" or scene.run.until != "pulse" or not before:
        return None
    state = motion.at(first.t_end / 2)
    return scene.replace(release=Release(float(state.phi), float(state.omega), float(state.slip_velocity)))


def flexible_margins(scene: Scene, thorough: bool, work: Work) -> Checked:
    """All checks of a flexible scene, and how it ended.

    A run that has used up its ``work`` is checked as far as it went.
    """
    motion = simulate(scene, history=True, progress=work, most_steps=work.steps)
    cut = work.cuts(motion)
    margins = listed(motion)
    if max(margins.values()) <= 1:
        margins |= _history(motion) | _ledger(motion)
        if thorough and motion.pulses and not cut:
            margins |= _again(motion, work)
    margins = {name: NO if isnan(value) else max(value, 0.0) for name, value in margins.items()}
    return Checked(margins, motion.ended, motion.completed and not cut, cut)


def against_all_nodes(scene: Scene, work: Work) -> Margins:
    """The normal impulse of the reduced hoop beside that of all nodes."""
    found = []
    for level in ("reduced", "full"):
        work.renew()
        motion = simulate(scene.replace(solve={"level": level}), progress=work, most_steps=work.steps)
        if work.cuts(motion):
            return {}
        found.append(impulses(motion)[:1])
    return {"all nodes": apart(*found) / (_allowed(scene) + 3e-3)}
