"""The map: hoops released at rest, over bending stiffness and one more key, and where in it they hop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rigid import Scene, SceneLike, as_scene, scene_to_dict
from rigid.elastic import TIGHTEST
from rigid.output import summary
from rigid.output.units import unit_names
from rigid.scenefile import units_of_keys

from ..running.case import Case, Outcome
from ..running.runs import run_cases
from ..running.workers import Pool, as_pool
from .rolling.asked import STIFFNESS, Ask, HopMap
from .rolling.energies import HopEnergies
from .rolling.roll import SOLVER, WHOLE, Flight
from .rolling.rule import DECADE, Scales
from .rolling.scaling import foreseen
from .rolling.threshold import TOLD, WHERE, HopCase, Line, windows

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

FINER = 3.0
"""By how much the tolerance is less at which thresholds are held against the map's."""

_COLUMNS = ("bending_stiffness", "k", "mass_ratio", "foundation", "mu_s", "mu", "damping", "chatter", "completed")
_THRESHOLD = ("value", "low", "high", "foreseen", "omega_1_t", "times_duration_squared", "gaps", "undecided_between")


@dataclass(frozen=True, slots=True, repr=False, eq=False)
class HopStudy(summary.Summarised):
    """What the study found: which hoops leave the floor, where, and below which bending stiffness.

    Attributes
    ----------
    scene : Scene
        From which all starts, as it was asked.
    second : str or None
        The key besides the bending stiffness, if there is one.
    lines : tuple of Line
        Rolls over the bending stiffness with their thresholds: a line for each value of the second key, or one.
    """

    scene: Scene
    second: str | None
    lines: tuple[Line, ...]

    @property
    def cases(self) -> list[HopCase]:
        """All rolls of map and bisection, line by line, softest first."""
        return [case for line in self.lines for case in _rolls(line)]

    @property
    def rolled(self) -> Scene:
        """The first roll as it was run: the scene with what a roll replaces, at the least value of either key."""
        return self.lines[0].mapped[0].scene

    @property
    def unfinished(self) -> list[HopCase]:
        """Those that stopped before their end."""
        return [case for case in self.cases if not case.motion["completed"]]

    @property
    def units(self) -> dict[str, str]:
        """What the numbers of table and JSON are measured in, by name; those of "energies" as "energies.friction"."""
        pure = dict.fromkeys((*_COLUMNS[:-1], *_THRESHOLD, "rtol", "hops"), "1")
        energies = unit_names(self.rolled, HopEnergies)
        parts = {f"energies.{name}": unit for name, unit in energies.items()}
        return {
            **units_of_keys(self._keys, self.rolled),
            **pure,
            **unit_names(self.rolled, Flight, Scales),
            "energy": energies["stored_in_ring"],
            **parts,
        }

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each hop, and one without a hop for each roll that has none."""
        import pandas

        rows: list[dict[str, Any]] = []
        for told in self._told():
            kept = {key: told[key] for key in (*self._keys, *_COLUMNS)}
            rows += [kept | {key: hop[key] for key in (*TOLD, "energy")} for hop in told["hops"]] or [kept]
        return pandas.DataFrame(rows)

    @property
    def _keys(self) -> tuple[str, ...]:
        """Those besides the bending stiffness."""
        return () if self.second is None else (self.second,)

    def _told(self) -> list[dict[str, Any]]:
        """Each roll as JSON prints it, with its value of the second key."""
        return [dict.fromkeys(self._keys, line.value) | case.to_dict() for line in self.lines for case in _rolls(line)]

    def plot(self) -> Figure:
        """The map where there is a second key, else where each hop begins."""
        from .figures import hop_map
        from .maps import map_figure

        return map_figure(self) or hop_map(self)

    def _title(self) -> str:
        over = STIFFNESS if self.second is None else f"{STIFFNESS} and {self.second}"
        return f"Hop study over {over}: {len(self.cases)} rolls, {len(self.unfinished)} stopped early"

    def _lines(self) -> list[summary.Line]:
        lines = []
        for line in self.lines:
            name = "all" if self.second is None else f"{line.value:g}"
            for where in line.windows:
                found = line.threshold(where)
                lines.append((f"{name}, {where}", found.told()))
        return lines

    def to_dict(self) -> dict[str, Any]:
        """As JSON prints it."""
        threshold: dict[str, Any] = {}
        for where in WHERE:
            rows = []
            for line in self.lines:
                if where not in line.windows:
                    continue
                row: dict[str, Any] = dict.fromkeys(self._keys, line.value) | line.threshold(where).to_dict()
                row["phi"] = line.angles(where)
                if where == "anywhere":
                    row["foreseen"] = foreseen(line.scene)
                row["omega_1_t"] = line.turning(where)
                row["times_duration_squared"] = line.times_duration(where)
                row["at_a_third_of_the_tolerance"] = line.holds(where)
                row["by_rule"] = {f"{f:.3g}": line.threshold(where, f).to_dict() for f in DECADE}
                rows.append(row)
            threshold[where] = rows
        return {
            "scene": scene_to_dict(self.scene),
            "as_run": scene_to_dict(self.rolled),
            "over": [STIFFNESS, *self._keys],
            "rtol": self.lines[0].scene.solve.rtol,
            "cases": self._told(),
            "threshold": threshold,
        }


def _rolls(line: Line) -> list[HopCase]:
    """Those of map and bisection, softest first."""
    return sorted((*line.mapped, *line.between), key=attrgetter("bending_stiffness"))


def hop_study(
    asked: HopMap | SceneLike,
    *,
    pool: Pool | None = None,
    out: str | Path | None = None,
    progress: Callable[[float], None] | None = None,
    say: Callable[[str], None] | None = None,
) -> HopStudy:
    """Roll the map, then close in on the thresholds.

    Parameters
    ----------
    asked : HopMap or Scene, str, path, dict
        What is rolled; of a scene, or of what says which (see :func:`rigid.simulate`), the map that has all else by
        default: ``HopMap(scene)``.
    pool, out, progress, say
        See :func:`studies.running.runs.run_cases`.

    Raises
    ------
    SceneError, StudyError
        What is asked is no scene, ``pool`` is none, or as of :class:`HopMap`.
    """
    if not isinstance(asked, HopMap):
        asked = HopMap(as_scene(asked))
    place = as_pool(pool)
    rounds = asked.bisections + 1 if asked.bisections else 0  # behind the map, which is most of the work
    shares = [0.0, *np.linspace(0.8, 1.0, rounds + 1).tolist()] if rounds else [0.0, 1.0]
    stage = 0
    done = 0.0

    def tell(share: float) -> None:
        """Never back: what has to be rolled on is rolled in the same stage."""
        nonlocal done
        done = max(done, share)
        if progress is not None:
            progress(done)

    def run(asks: list[Ask]) -> list[tuple[int, HopCase]]:
        """Rolls, those that are not asked whole only through the pulse where that decides."""
        scenes = [asked.scene_of(ask) for ask in asks]
        cases = [Case(WHOLE if asked.whole else SOLVER, scene, cut=True) for scene in scenes]
        low, high = shares[stage : stage + 2]
        part = " of the map" if stage == 0 and asked.bisections else ""
        outcomes = run_cases(cases, place, out, lambda share: tell(low + (high - low) * share), say=say, part=part)
        found = [
            (ask.line, HopCase(ask.stiffness, scene, outcome, ask.whole and _to_its_end(outcome)))
            for ask, scene, outcome in zip(asks, scenes, outcomes, strict=True)
        ]
        late = [not (ask.whole or _through(lines[ask.line], case)) for ask, (_, case) in zip(asks, found, strict=True)]
        again = (
            run([ask._replace(whole=True) for ask, more in zip(asks, late, strict=True) if more]) if any(late) else []
        )
        return [each for each, more in zip(found, late, strict=True) if not more] + again

    lines: list[Line] = []
    # softest first: they are the dearest, and none is left alone at the end
    found = run([Ask(n, s, asked.rtol, True) for s in asked.stiffness for n in range(len(asked.scenes))])
    lines = [
        Line(value, scene, windows(scene), tuple(case for m, case in found if m == n))
        for n, (value, scene) in enumerate(zip(asked.values, asked.scenes, strict=True))
    ]
    for _ in range(asked.bisections):
        stage += 1
        more = run(
            [Ask(n, s, asked.rtol, w) for n, line in enumerate(lines) for s, w in sorted(_middles(line).items())]
        )
        lines = [_with(line, between=[case for m, case in more if m == n]) for n, line in enumerate(lines)]
    if not asked.bisections:
        return HopStudy(asked.scene, asked.second, tuple(lines))
    stage += 1
    finer = max(asked.rtol / FINER, TIGHTEST)
    more = run([Ask(n, s, finer, w) for n, line in enumerate(lines) for s, w in sorted(_ends(line).items())])
    lines = [_with(line, finer=[case for m, case in more if m == n]) for n, line in enumerate(lines)]
    return HopStudy(asked.scene, asked.second, tuple(lines))


def _to_its_end(outcome: Outcome) -> bool:
    """Whether a roll went on to its end where all was decided before."""
    return bool((outcome.motion or {}).get("whole", True))


def _with(line: Line, between: list[HopCase] | None = None, finer: list[HopCase] | None = None) -> Line:
    added = sorted([*line.between, *(between or [])], key=lambda case: case.bending_stiffness)
    return Line(line.value, line.scene, line.windows, line.mapped, tuple(added), (*line.finer, *(finer or [])))


def _middles(line: Line) -> dict[float, bool]:
    """Stiffnesses in the middle of the line's brackets, and whether they are to be rolled to the end."""
    known = line.answers("anywhere")
    found: dict[float, bool] = {}
    for where in line.windows:
        b = line.threshold(where)
        if b.value is not None and not b.open and b.value not in known:
            found[b.value] = found.get(b.value, False) or where == "anywhere"
    return found


def _ends(line: Line) -> dict[float, bool]:
    """The ends of its brackets, likewise."""
    found: dict[float, bool] = {}
    for where in line.windows:
        b = line.threshold(where)
        for end in (b.low, b.high) if b.value is not None else ():
            found[end] = found.get(end, False) or where == "anywhere"
    return found


def _through(line: Line, case: HopCase) -> bool:
    """Whether a roll through the pulse got there, or would not by going on."""
    return not case.motion["completed"] or case.motion["swept"] > line.windows["pulse"].high  # type: ignore[union-attr]
