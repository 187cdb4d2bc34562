"""`hoop bench knobs`: what elements, modes, points and steps each leave of a pulse, at the tolerance that chose them.

One knob, ``rtol``, turns four. Each of them is made finer by itself, with steps so short that they do not matter, and
what that changes is its error; that of the steps is what shorter ones change. In impulses and loss, over J_N.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import inf

from flexible.contact.laws.listing import LAWS
from flexible.models.reduced import ReducedHoop
from flexible.models.rim_contact import points_to_a_patch
from flexible.ring.choice import elements_around, elements_through, forget_rings
from flexible.ring.rim.reduction import modes_for
from rigid import Scene

from .race import Claim, Result, Row
from .truth.reference import Measured, errors, massless_brush, massless_pulse, run_hoop, scene_b

KNOBS = ("elements", "modes", "points", "steps")
FINER = 3  # times as many elements around and through, and modes
MOST_AROUND, MOST_THROUGH = 1440, 16  # however: the compliance of a longer rim is half a GB
SHIFTS = (1.0037, 1.0071, 2.0)  # of the number of points: parts of a thousand put them anywhere in the patch
SHORT = 1 / 30  # of the tolerance: steps that do not matter
LEAST_RTOL = 3e-7  # however
MOST = 1.0  # times its tolerance a knob may leave, and all of them together


@dataclass(frozen=True)
class Pulse:
    """A scene to the end of its first pulse, or to its ``t_end`` from an undeformed ring."""

    name: str
    scene: Scene


@dataclass(frozen=True)
class Setting:
    """The four knobs."""

    around: int
    through: int
    modes: int
    points: float
    rtol: float

    @classmethod
    def of(cls, scene: Scene, rtol: float) -> Setting:
        """As ``rtol`` chooses them."""
        soft, wall = scene.ring.bending_stiffness, scene.wall
        points = points_to_a_patch(LAWS[scene.contact.law], rtol)
        around, through = elements_around(rtol, soft, wall), elements_through(wall, rtol)
        return cls(around, through, modes_for(rtol, wall) if scene.hoop.mass_ratio > 0 else 0, points, rtol)

    def on_finer_elements(self) -> Setting:
        """The same on ``FINER`` times as many, as far as memory goes."""
        around, through = min(FINER * self.around, MOST_AROUND), min(FINER * self.through, MOST_THROUGH)
        return replace(self, around=around, through=through)


def pulses(quick: bool) -> list[Pulse]:
    """Rings that ring and do not, on patch and brush; thin walls and thick ones."""
    stiff = scene_b().replace(ring={"bending_stiffness": 1e4}, contact={"damping": 1.0})
    few = [
        Pulse("scene B", scene_b()),
        Pulse("massless, patch", massless_pulse()),
    ]
    if quick:
        return few
    return [
        *few,
        Pulse("massless, brush", massless_brush()),
        Pulse("scene B, E I = 10⁴, damped", stiff),
        *(Pulse(f"scene B, r = {r:g}", scene_b().replace(hoop={"r": r})) for r in (1.005, 1.05, 1.1, 1.2)),
    ]


def pulse_at(scene: Scene, setting: Setting) -> Measured:
    """Impulses, loss and largest force of a pulse with these knobs.

    Raises
    ------
    RuntimeError
        The run did not come to its end.
    """
    solve = {"rtol": setting.rtol, "elements": setting.around, "through": setting.through}
    scene = scene.replace(solve=solve)
    return run_hoop(scene, ReducedHoop(scene, setting.modes, setting.points))


@dataclass
class Budget:
    """What the knobs of a pulse leave at a tolerance."""

    parts: dict[str, float] = field(default_factory=dict)
    all: float = inf
    """What finer ones change together."""
    all_peak: float = inf
    """That of the largest normal force, relative."""
    seconds: float = 0.0
    """Of the run with the chosen ones, the ring taken from the cache."""


def budget(scene: Scene, rtol: float, done: Callable[[], None] = lambda: None) -> Budget:
    """Turn one knob after the other; ``done`` is called after each run."""

    def run(setting: Setting) -> Measured:
        found = pulse_at(scene, setting)
        done()
        return found

    chosen = Setting.of(scene, rtol)
    still = replace(chosen, rtol=max(SHORT * rtol, LEAST_RTOL))
    finer = still.on_finer_elements()
    true = run(still)  # on a ring that is made now
    start = time.process_time()
    found = run(chosen)
    seconds = time.process_time() - start
    off: dict[str, float] = {"elements": errors(run(finer), true)[0]}
    if chosen.modes:
        off["modes"] = errors(run(replace(still, modes=FINER * chosen.modes)), true)[0]
    off["points"] = max(errors(run(replace(still, points=by * chosen.points)), true)[0] for by in SHIFTS)
    off["steps"] = errors(found, true)[0]
    finest = run(replace(finer, modes=FINER * chosen.modes, points=2 * chosen.points))
    return Budget(off, *errors(found, finest), seconds)


def bench(quick: bool = False, peers_too: bool = False, progress: Callable[[float], None] | None = None) -> Result:
    """The budget of every pulse at every tolerance, and what is stated of it."""
    jobs = [(pulse, rtol) for pulse in pulses(quick) for rtol in ((1e-3, 1e-4) if quick else (1e-2, 1e-3, 1e-4, 1e-5))]
    runs, made = len(jobs) * (len(KNOBS) + len(SHIFTS) + 1), 0

    def done() -> None:
        nonlocal made
        made += 1
        if progress is not None:
            progress(min(made / runs, 1.0))

    result = Result(parts=KNOBS)
    for pulse, rtol in jobs:
        row = Row("hoop-pulse reduced", f"rtol {rtol:.0e}", pulse.name, [])
        result.rows.append(row)
        try:
            found = budget(pulse.scene, rtol, done)
        except RuntimeError as trouble:
            row.note = str(trouble)
            continue
        finally:
            forget_rings()
        row.seconds.append(found.seconds)
        row.error, row.more = found.all, {**found.parts, "error_peak": found.all_peak, "rtol": rtol}
        name = f"{pulse.name}, rtol {rtol:.0e}: the largest part, or all, over rtol"
        result.claims.append(Claim(name, max(*found.parts.values(), found.all) / rtol, MOST, at_most=True))
    return result
