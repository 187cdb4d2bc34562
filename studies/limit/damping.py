"""How much damping the limit needs: a rigid ring on a compliant floor over damping ratio and foundation.

The ringing that the end of a slip leaves in a patch decays and breaks the stick early where it is still there when the
rigid hoop would slip again. So the distance to the limit, beyond what is predicted for a patch that has come to rest,
depends on x = zeta omega T alone: zeta and omega the patch's own damping ratio and frequency at that stiffness and the
N of the stick, T the rigid hoop's stick time.

Where rolling takes more than mu N behind the end of a slip, a patch that breaks there does not stick again, and less
damping has another limit (:func:`others`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, pi
from typing import Any

from flexible.contact.laws.listing import LAWS
from rigid import Scene, simulate

from ..inner.events import STOP
from ..inner.layers import period_of
from ..inner.march.equations import PATCH
from ..inner.scales import epsilon, theta_of
from ..inner.stops.hanging import followed, hanging
from ..plots.sheet import number
from ..running.files import StudyError
from .compliant import at_foundation, go_through
from .prediction import ROUND_OFF, Prediction, foreseen, predict

DAMPINGS = (0.0, 0.003, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
AROUND = (0.7, 1.5, 3.0)
"""Times a critical ratio at which the limit changes, beside these."""
FOUNDATIONS = (1e8, 1e9, 1e10, 1e11, 1e12)


@dataclass(frozen=True, slots=True)
class Other:
    """A way to be compliant, and where it leads."""

    name: str
    """Law and damping."""
    impulse_ratio: tuple[float, float]
    """J_F/J_N in the limit, twice; where there is none, the least and the largest of those observed."""
    prediction: Prediction | None = None
    """How it comes there, at this scene's damping; None where that is not predicted."""
    tends: bool = True
    """Whether there is a limit."""


@dataclass(frozen=True, slots=True)
class Spot:
    """One pulse of the map."""

    damping: float
    foundation: float
    decay: float
    """x: how often the ringing falls by e within the stick."""
    impulse_ratio: float
    limit: float
    predicted: float
    """Of a patch that comes to rest."""

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        return {name: getattr(self, name) for name in self.__slots__}


def damping_map(
    scene: Scene, dampings: Sequence[float] | None = None, foundations: Sequence[float] = FOUNDATIONS
) -> list[Spot]:
    """The first pulse's J_F/J_N over damping ratio and foundation; the ratios are by default those of a scene's own
    map (:func:`dampings_of`)."""
    spots = []
    for damping in dampings_of(scene) if dampings is None else dampings:
        damped = scene.replace(contact={"damping": damping})
        prediction = predict(damped)
        term = prediction.terms["impulse_ratio"]
        for foundation in foundations:
            here = at_foundation(damped, foundation)
            seen = go_through(here).impulse_ratio
            small = foundation ** (-1 / 3) if prediction.parameter == "eps" else here.contact.slip_velocity_scale
            predicted = float(term.at(small))
            spots.append(Spot(damping, foundation, decay_in_stick(here), seen, term.limit, predicted))
    return spots


def dampings_of(scene: Scene) -> tuple[float, ...]:
    """Damping ratios of a map: some on both sides of each critical one, too, at which the limit is another."""
    critical = [stop.damping for stop in hanging(scene, followed(scene)) if stop.damping is not None]
    beside = {float(f"{part * ratio:.3g}") for ratio in critical if ratio < inf for part in AROUND}
    return tuple(sorted({*DAMPINGS, *beside}))


def decay_in_stick(scene: Scene) -> float:
    """x of a scene's shortest stick: theta omega^2/2 times its duration, omega the frequency on the tau clock.

    With H'' = -omega^2 (H + theta H') the ringing decays at the rate theta omega^2/2. Infinite where no stick ends
    within the pulse, or the patch keeps none.
    """
    way = followed(scene)
    least = inf
    for now, following in zip(way.events, way.events[1:], strict=False):
        if now.kind == STOP:
            rate = theta_of(scene) * (2 * pi / period_of(way.body, now)) ** 2 / 2
            least = min(least, rate * (following.t - now.t) / epsilon(scene))
    return least


def others(scene: Scene, foundations: Sequence[float]) -> tuple[Other, ...]:
    """The limits of the three laws, and what is seen at some foundations of a patch without a damper."""
    found: list[Other] = []
    for name, law in LAWS.items():
        pulses = simulate(scene.replace(friction={"mu_s": law.static_coefficient(scene.friction)})).pulses
        for pulse in [p for p in pulses if not p.cut][:1]:
            found += _of_law(scene.replace(contact={"law": name}), pulse.impulse_ratio, foreseen(scene, name))
    ideal = next(name for name, law in LAWS.items() if law.code == PATCH)
    undamped = scene.replace(contact={"law": ideal, "damping": 0.0})
    try:
        limit = predict(undamped).terms["impulse_ratio"].limit
        seen = [go_through(at_foundation(undamped, foundation)).impulse_ratio for foundation in foundations]
    except StudyError:  # the pulse of this law is another, and none that can be foreseen
        return tuple(found)
    near = max(abs(seen[0] - limit) / 2, ROUND_OFF)  # it comes to a fifth, where it has a limit
    comes = abs(seen[-1] - limit) <= near
    return (*found, Other(f"{ideal}, no damping", (limit, limit) if comes else (min(seen), max(seen)), tends=comes))


def _of_law(scene: Scene, kept: float, here: Prediction | None) -> list[Other]:
    """Limits of a law: that of its own rigid hoop, ``kept``, and where a stick that breaks makes another that too."""
    hangs = () if here is None else hanging(scene, followed(scene))
    name, damping = scene.contact.law, scene.contact.damping
    if here is None or not hangs:
        return [Other(f"{name}, any damping", (kept, kept), here)]
    least = max(inf if each.damping is None else each.damping for each in hangs)
    said = f"{name}, damping above {number(least, 4)}" if least < inf else f"{name} that keeps its stick"
    if damping > least:
        return [Other(said, (kept, kept), here)]
    limit = here.terms["impulse_ratio"].limit
    # what an undamped patch does is looked at, below
    own = [] if damping == 0 else [Other(f"{name}, damping {number(damping)}", (limit, limit), here)]
    return [Other(said, (kept, kept)), *own]
