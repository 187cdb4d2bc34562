"""Where a compliant hoop's pulse tends to as stiffness grows, how fast, and what its damping must be for that.

The answer comes from the inner problems of the rigid hoop's own events and from its own sensitivities; no stiffness is
run for it. Beside it stands what a rigid ring on a compliant floor, and the flexible solver, do at a few great ones.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rigid import Run, Scene, SceneLike, as_scene, scene_to_dict
from rigid.allowed import require_list
from rigid.output import summary

from ..inner.creep import creep
from ..inner.events import Event, Passage
from ..inner.layers import Layer, TooLongError, layer, outer_forces
from ..inner.scales import damping_of
from ..inner.separate import separate_from, stiff_from
from ..inner.stops.critical import critical_theta
from ..inner.stops.hanging import Hanging, followed, hanging
from ..plots.sheet import power_of
from ..running.measures import MEASURES, known
from ..running.workers import Pool, as_pool
from .compliant import Sight, at_foundation, seen_by_flexible, seen_by_rigid_rings, times_off
from .damping import Other, others
from .prediction import Prediction, predict, units_told

if TYPE_CHECKING:
    import pandas

OBSERVED = ("impulse_ratio", "friction_impulse", "normal_impulse", "friction_loss")
"""Measures that are predicted and observed."""
SOLVERS = ("rigid ring", "flexible")
COLUMNS = ("solver", "foundation", "measure", "value", "numerical_error", "limit", "distance", "predicted", "failure")
"""Of a study's table."""
FOUNDATIONS = (1e10, 1e11, 1e12)
"""At which the rigid ring is observed; a decade makes the distance 2.15 times smaller."""


@dataclass(frozen=True, slots=True)
class EventFound:
    """An event of the rigid motion and its inner problem."""

    event: Event
    before: tuple[float, float]
    """(N, F) of the rigid hoop before it, over the weight of the whole hoop."""
    behind: tuple[float, float]
    """Behind it."""
    layer: Layer | None
    """History on the clock tau = (t - t*)/eps; None where its damper, or the smoothing of its friction, is too fast."""
    critical_damping: float | None
    """Damping ratio below which the patch breaks or sticks once more than the paper's hoop; None without phases."""
    creep: float
    """V towards which the layer goes; 0 where the hoop slides."""
    failure: str = ""
    """Why there is no layer."""

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        return {
            "kind": self.event.kind,
            "t": self.event.t,
            "phi": self.event.phi,
            "omega": self.event.omega,
            "normal_force": [self.before[0], self.behind[0]],
            "friction_force": [self.before[1], self.behind[1]],
            "peak_ratio": self.layer and self.layer.peak_ratio,
            "critical_damping": self.critical_damping,
            "resticks": self.layer and self.layer.resticks,
            "settles": self.layer and self.layer.settled(self.behind[0]),
            "creep": self.creep,
            "period": self.layer and self.layer.period,
            **({"failure": self.failure} if self.failure else {}),
        }


@dataclass(frozen=True, slots=True, repr=False, eq=False)
class LimitStudy(summary.Summarised):
    """What the study found of a scene: the limit of its first pulse, how it is approached, and runs beside that.

    Attributes
    ----------
    scene : Scene
        As it was studied, with its damping.
    events : tuple of EventFound
        Of the first pulse and the stretch before it in which the flexible hoop settles.
    prediction : Prediction
        Limit and approach.
    separate : float
        Foundation from which on the layers are over before the next event comes, so that the prediction holds; infinite
        where a layer does not settle: without damping.
    sights : tuple of Sight
        What was observed at a finite stiffness.
    others : tuple of Other
        What the same hoop tends to under other compliances, this one's among them.
    stiff : float
        Foundation from which on the ring, in the scene's proportion to it, gives way by less than the patch.
    hanging : tuple of Hanging
        Stops that a patch of less damping than there says slides through, or may, at any stiffness.
    """

    scene: Scene
    events: tuple[EventFound, ...]
    prediction: Prediction
    separate: float
    sights: tuple[Sight, ...]
    others: tuple[Other, ...]
    stiff: float = 0.0
    hanging: tuple[Hanging, ...] = ()

    def otherwise(self, sight: Sight) -> bool:
        """Whether what was observed is not yet near the limit: a stick on which that hangs is kept, or lost, the other
        way."""
        ratio = sight.values.get("impulse_ratio")
        return ratio is not None and any(
            stop.is_otherwise(ratio, ratio - np.subtract(*self.distance("impulse_ratio", sight)))
            for stop in self.hanging
        )

    def unlike(self, solver: str) -> tuple[float, dict[str, float]]:
        """The stiffest foundation of a solver, and by how many times what is predicted each measure is off there.

        Of those whose distance has not the predicted sign, or less than half or more than twice its size.
        """
        seen = [s for s in self.sights if s.solver == solver and s.values]
        if not seen or not self.prediction.complete or self.otherwise(last := max(seen, key=lambda s: s.foundation)):
            return 0.0, {}
        return last.foundation, times_off(last, {name: self.distance(name, last) for name in last.values})

    def _title(self) -> str:
        return f"Limit study: {len(self.events)} events, {len(self.sights)} runs beside them"

    def _lines(self) -> list[summary.Line]:
        terms = self.prediction.terms.items()
        lines = [(n, f"{term.limit:.6g} + {term.coefficient:.4g} {power_of('x', term.exponent)}") for n, term in terms]
        parameter = "foundation^(-1/3)" if self.prediction.parameter == "eps" else "the slip velocity scale"
        return [*lines, ("x", parameter), ("events", ", ".join(found.event.kind for found in self.events))]

    def plot(self, *names: str, axes: Any = None) -> NDArray[np.object_]:
        """Distance to the limit over the foundation, predicted and observed, a panel for each of ``names``.

        These are of ``OBSERVED``, by default the impulses and their ratio; on ``axes`` or in a new figure.
        """
        from ..plots.approach import Approach, draw

        foundations = [sight.foundation for sight in self.sights] or [1e8]
        along = np.geomspace(min(*foundations, 1e9), max(*foundations, 1e13), 60)
        drawn = {}
        for name in names or OBSERVED[:3]:
            term = known(self.prediction.terms, name)
            away = np.array([float(term.at(self.small(s))) - term.limit for s in along])
            seen = {}
            for solver in SOLVERS:
                mine = [sight for sight in self.sights if sight.solver == solver and name in sight.values]
                pairs = np.array([(sight.foundation, self.distance(name, sight)[0]) for sight in mine]).reshape(-1, 2)
                seen[solver] = pairs[:, 0], pairs[:, 1]
            drawn[MEASURES[name].formula(self.scene)] = Approach((along, away), seen)
        return draw(drawn, r"foundation $\varepsilon_n R^2/(mg)$", axes)

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each measure of each run: value, numerical error, distance to the limit, and what was predicted."""
        import pandas

        rows = []
        for sight in self.sights:
            for name in (each for each in OBSERVED if each in sight.values or sight.failure):
                row: list[Any] = [sight.solver, sight.foundation, name, *[None] * 5, sight.failure]
                if name in sight.values:
                    limit, seen = self.prediction.terms[name].limit, sight.values[name]
                    row[3:8] = seen, sight.errors.get(name), limit, *self.distance(name, sight)
                rows.append(row)
        return pandas.DataFrame(rows, columns=list(COLUMNS))

    def small(self, foundation: float) -> float:
        """The prediction's small parameter at a foundation."""
        if self.prediction.parameter == "eps":
            return foundation ** (-1 / 3)
        return float(at_foundation(self.scene, foundation).contact.slip_velocity_scale)

    def distance(self, name: str, sight: Sight) -> tuple[float, float]:
        """(observed, predicted) distance of a measure from its limit."""
        term = self.prediction.terms[name]
        return sight.values[name] - term.limit, float(term.at(self.small(sight.foundation))) - term.limit

    @property
    def units(self) -> dict[str, str]:
        """What the numbers of table and JSON are measured in, by name."""
        return units_told(self.scene)

    def to_dict(self) -> dict[str, Any]:
        """The study as JSON prints it; coefficients are distances over the leading power of the small parameter."""
        observed: dict[str, Any] = {}
        for name in OBSERVED:
            power = self.prediction.terms[name].exponent
            rows = []
            for sight in (each for each in self.sights if each.failure or name in each.values):
                row: dict[str, Any] = {"solver": sight.solver, "foundation": sight.foundation}
                if sight.failure:
                    row["failure"] = sight.failure
                else:
                    scale = self.small(sight.foundation) ** power
                    found, foreseen = self.distance(name, sight)
                    row |= {"value": sight.values[name], "coefficient": found / scale, "predicted": foreseen / scale}
                    if name in sight.errors:
                        row["numerical_error"] = sight.errors[name]
                rows.append(row)
            observed[name] = rows
        return {
            "scene": scene_to_dict(self.scene),
            "events": [found.to_dict() for found in self.events],
            "parameter": self.prediction.parameter,
            "complete": self.prediction.complete,
            "prediction": {name: term.to_dict() for name, term in self.prediction.terms.items()},
            "separate": self.separate,
            "hanging": [stop.to_dict() for stop in self.hanging],
            "stiff": self.stiff,
            "others": [{"name": other.name, "impulse_ratio": list(other.impulse_ratio)} for other in self.others],
            "observed": observed,
            "unlike": [
                {"solver": solver, "foundation": at, "measure": name, "over_predicted": times}
                for solver in SOLVERS
                for at, off in [self.unlike(solver)]
                for name, times in off.items()
            ],
        }


def limit_study(
    scene: SceneLike,
    *,
    foundations: float | Sequence[float] = FOUNDATIONS,
    flexible: float | Sequence[float] = (),
    pool: Pool | None = None,
    out: Any = None,
    progress: Callable[[float], None] | None = None,
) -> LimitStudy:
    """Solve the limit of a scene's first pulse.

    Parameters
    ----------
    scene : Scene, str, path or dict
        Its foundation does not matter, its ``contact.damping`` does.
    foundations : float or sequence of float
        Where a rigid ring on a compliant floor is observed.
    flexible : float or sequence of float
        Where the flexible solver is, its bending stiffness raised in the scene's proportion.
    pool, out, progress
        For the flexible solver's runs, see :func:`studies.running.runs.run_cases`.

    Raises
    ------
    SceneError
        What is no foundation.
    StudyError
        ``pool`` is none; there is no pulse, or there is more in it than rolling and sliding.
    """
    scene = as_scene(scene).replace(run=Run(until="pulse"))
    foundations, flexible = (
        require_list(name, given, 0, inf, "a foundation is above 0", open_low=True)
        for name, given in (("foundations", foundations), ("flexible", flexible))
    )
    for foundation in (*foundations, *flexible):
        at_foundation(scene, foundation)  # what cannot be is refused before the work
    pool, way = as_pool(pool), followed(scene)
    prediction = predict(scene)
    found = []
    for event in way.events:
        history, failure = _layer_of(way, event)
        theta = critical_theta(way.body, way.contact, event.stop)
        behind = outer_forces(way.body, event, True)
        slow = creep(way.contact, *behind, event.omega).slip if event.behind is None else 0.0
        found.append(
            EventFound(
                event, outer_forces(way.body, event, False), behind, history,
                None if theta is None else damping_of(scene, theta), slow, failure,
            )
        )  # fmt: skip
    sights = seen_by_rigid_rings(scene, foundations)
    limits = {name: prediction.terms[name].limit for name in OBSERVED}
    sights += seen_by_flexible(scene, limits, flexible, pool, out, progress)
    separate = separate_from(way, [event.layer for event in found])
    stiff, hangs = stiff_from(way, scene), hanging(scene, way)
    return LimitStudy(
        scene, tuple(found), prediction, separate, tuple(sights), others(scene, FOUNDATIONS), stiff, hangs
    )


def _layer_of(way: Passage, event: Event) -> tuple[Layer | None, str]:
    """The layer of an event, or why it cannot be followed."""
    try:
        return layer(way.body, way.contact, event), ""
    except TooLongError as error:
        return None, str(error)
