"""The energy ledger of a flexible motion as an account that adds up, and what has to be said of the motion."""

from __future__ import annotations

import dataclasses
from math import floor, log10
from typing import TYPE_CHECKING

from rigid import Kind
from rigid.output.units import Unit

if TYPE_CHECKING:
    from flexible import FlexibleMotion

HEADING = "Energy ledger: the first line is the sum of the others"

NOTED = 1e-3
"""Share of the energy from which on a hand-over is spoken of."""

TAKEN = 2.0
"""What the integrator may take for each pulse, over rtol times the energy, before it is spoken of; without vibrations
that its steps do not follow it takes 0.5 at most."""

LEFT = 2.0
"""The same of what is in no book: at most 1.1 in a pulse without a landing, with one mostly less."""


def account(motion: FlexibleMotion) -> list[tuple[str, str]]:
    """Entries of the ledger by name, with as many decimals for all as give the largest seven digits."""
    books = dataclasses.asdict(motion.ledger)
    largest = max(map(abs, books.values()))
    decimals = min(max(6 - floor(log10(largest)), 0), 300) if largest > 0 else 0
    # the other zero has no sign
    return [(name.replace("_", " "), f"{round(value, decimals) + 0.0:.{decimals}f}") for name, value in books.items()]


def remarks(motion: FlexibleMotion) -> list[str]:
    """Sentences on the ledger and on the phases."""
    return [sentence for sentence in (_hand_over(motion), _taken(motion), _left(motion), _chatter(motion)) if sentence]


def _hand_over(motion: FlexibleMotion) -> str:
    if motion.ledger.hand_over == 0:
        return ""
    scene, changed = motion.scene, abs(motion.ledger.hand_over)
    said = (
        "Hand over: energy that left (< 0: came in) where the rigid hoop, which stands for the flexible one between "
        "pulses, gave way to it and came back."
    )
    held = max(abs(motion.ledger.initial), scene.energy_unit)
    if changed > NOTED * held:
        said += (
            f" It is {changed / held:.1%} of the energy: sag, patch or vibration are too large to be left out between "
            'pulses; solve.resolve = "all" keeps them.'
        )
    return said


def _share(motion: FlexibleMotion, energy: float, most: float) -> float:
    """Of the energy of a motion, by size; 0 where it is no more than so many times rtol for each pulse."""
    share = abs(energy) / max(abs(motion.ledger.initial), motion.scene.energy_unit)
    return share if share > most * motion.scene.solve.rtol * max(1, len(motion.pulses)) else 0.0


def _taken(motion: FlexibleMotion) -> str:
    took, rtol = _share(motion, motion.ledger.numerical_loss, TAKEN), motion.scene.solve.rtol
    if not took:
        return ""
    way = "took" if motion.ledger.numerical_loss > 0 else "gave"
    return (
        f"Numerical loss: the steps {way} {took:.2g} of the energy, in vibrations faster than they follow. "
        f"What hangs on those may be further off than solve.rtol = {rtol:g}; a run with a smaller one shows how far."
    )


def _left(motion: FlexibleMotion) -> str:
    left, rtol = _share(motion, motion.ledger.residual, LEFT), motion.scene.solve.rtol
    if not left:
        return ""
    return (
        f"Residual: {left:.2g} of the energy is in none of the books, as where spots of the rim land or snap "
        f"off within a step. A run with a solve.rtol below {rtol:g} shows whether the motion is another one."
    )


def _chatter(motion: FlexibleMotion) -> str:
    from flexible.models.rim_contact import patch_period

    scene = motion.scene
    period = patch_period(scene) * scene.time_unit
    flexible = [phase for pulse in motion.pulses for phase in getattr(pulse, "phases", ())]
    hops = sum(phase.kind == Kind.FLIGHT and phase.t_end - phase.t_start < period for phase in flexible)
    if not hops:
        return ""
    damping, told = scene.contact.damping, f"{period:.3g} {Unit.TIME.label(scene)}"
    how = f"The contact, damped at {damping:g}," if damping > 0 else "The undamped contact"
    ends = "which a larger one need not end: it is the ring that vibrates" if damping > 0 else "which one may end"
    return (
        f"{how} chatters in the pulses: {hops} of their {len(flexible)} phases are hops shorter than a period of the "
        f"patch's own vibration, {told}; contact.damping = {damping:g}, {ends}."
    )
