"""What must hold for any flexible scene."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from math import isfinite, isnan

import numpy as np

from flexible import FlexibleMotion, simulate
from rigid import Scene

from .stress_checks import NO, Margins, in_si, listed, mirrored

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
    # Newton meets the forces to 1e-9 of the weight, or of themselves
    margins["|F| <= mu_s N"] = float((np.abs(friction) - bound).max()) / (1e-6 * most)
    return margins


def _ledger(motion: FlexibleMotion) -> Margins:
    """Energy is where the ledger says, nothing is gained and no loss is negative."""
    books = motion.ledger
    values = dataclasses.asdict(books)
    if not all(map(isfinite, values.values())):
        return {"finite": NO}
    scale = max(1.0, abs(books.initial), books.kinetic)
    held = books.kinetic + books.gravity + books.ring_strain + books.contact_spring
    lost = books.friction_loss + books.damping_loss + books.numerical_loss
    allowed = _allowed(motion.scene) * scale
    return {
        "ledger closed": abs(held + lost - books.initial - books.hand_over) / scale / 1e-9,
        "numerical loss": abs(books.numerical_loss) / allowed,
        "losses >= 0": -min(books.friction_loss, books.damping_loss, 0.0) / allowed,
    }


def _measures(motion: FlexibleMotion) -> np.ndarray:
    return np.array([(p.normal_impulse, p.friction_impulse) for p in motion.pulses[:1]]).reshape(-1, 2)


def _apart(a: np.ndarray, b: np.ndarray) -> float:
    if a.shape != b.shape:
        return NO
    return float(np.abs(a - b).max(initial=0.0) / max(1.0, np.abs(a).max(initial=0.0)))


def flexible_margins(scene: Scene, thorough: bool, watch: Callable[[float], None]) -> tuple[Margins, str]:
    """All checks of a flexible scene, and how it ended.

    ``watch`` is called in every step and may stop the run.
    """
    motion = simulate(scene, history=True, progress=watch)
    margins = listed(motion)
    if not any(margins.values()):
        margins |= _history(motion) | _ledger(motion)
        if thorough and motion.pulses:
            # a rerun may take other steps: it agrees as the tolerance promises, not to round-off
            allowed = _allowed(scene)
            other = simulate(mirrored(scene), progress=watch)
            margins["mirrored"] = _apart(_measures(motion), _measures(other) * (1, -1)) / allowed
            si = in_si(scene)
            other = simulate(si, progress=watch)
            margins["in SI units"] = _apart(_measures(motion), _measures(other) / si.impulse_unit) / allowed
    return {name: NO if isnan(value) else max(value, 0.0) for name, value in margins.items()}, motion.ended


def against_all_nodes(scene: Scene, watch: Callable[[float], None]) -> Margins:
    """The normal impulse of the reduced hoop beside that of all nodes."""
    reduced, full = (simulate(scene.replace(solve={"level": level}), progress=watch) for level in ("reduced", "full"))
    return {"all nodes": _apart(_measures(reduced), _measures(full)) / (_allowed(scene) + 3e-3)}
