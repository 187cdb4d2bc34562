"""One scene through one solver, made into a row that can be stored, compared and sent between machines."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Any

from rigid import Motion, Scene, scene_to_dict
from rigid.elastic import TIGHTEST
from rigid.kernel.announce import running_clock
from rigid.output.file import version

from .files import plain
from .history import Columns, through
from .measures import MEASURES, enter_from, measures, phase_sequence
from .solvers import build_here, solver

SHARE = 0.1
"""Numerical error may be this share of the distance that a study reports."""

SAME = 1e-13
"""A measure this near to the rigid one, in its unit, is that in any run, as J_F/J_N = mu where a pulse slides
throughout: there is no distance to resolve."""
NEGLIGIBLE = 1e-7
"""Numerical error below this (J_F/J_N, or m g R) is not made smaller: a measure may happen to cross the rigid value,
and no error is a tenth of nothing."""

FINER = 4.0
"""By how much the second run of a pair is the finer in its tolerance."""

REMAINS = 1.0
"""Error that is left in the finer run of a pair, over the change from the other one. An error like rtol leaves a third;
but the instant at which a stick breaks is known no better than either run has it, by luck of single steps."""

MOST_STEPS = 20_000
"""No case is tightened beyond this many steps in all of its finer runs, some 10 s of the flexible solver. Steps and
not seconds: a case must come out the same on a busy machine."""

NOISY = 2.0
"""Steps of a tighter run over those to expect from which on it is noise: with steps shorter than a single point of
the rim takes into the patch, the solver follows the jitter that each of them gives a sticking patch, in many more
steps and to a result that jitters too. Longer steps average over the points."""


@dataclass(frozen=True, slots=True)
class Case:
    """A scene, the solver that runs it, and what is asked of the result.

    Parameters
    ----------
    solver : str
        "rigid", "flexible" or ``module:function``.
    scene : Scene
        What is run.
    against : tuple of (str, float, float)
        Values of the first pulse's measures that this case will be compared to, and the distances from them that are
        expected, 0 where nothing is. When given, the tolerance is tightened from the scene's until the numerical error
        is at most ``SHARE`` of each distance, or of the expected one where that is larger: one that passes through zero
        asks for no more.
    histories : bool
        Whether the forces through each pulse come back too.
    build : str
        Version, sources, packages and measures that it is meant for, by default those of this process.
    cut : bool
        Whether a motion that stops before what was asked is a result too, as far as it came; otherwise it is a failure.
    """

    solver: str
    scene: Scene
    against: tuple[tuple[str, float, float], ...] = ()
    histories: bool = False
    build: str = ""
    cut: bool = False

    def __post_init__(self) -> None:
        if not self.build:
            object.__setattr__(self, "build", build_here(self.solver))

    @property
    def key(self) -> str:
        """Under which the result is stored: a hash of all that determines it, sources and versions of packages too."""
        described = {
            "solver": self.solver,
            "scene": _floats(scene_to_dict(self.scene)),
            "against": [list(entry) for entry in self.against],
            "histories": self.histories,
            "build": self.build,
            "cut": self.cut,
        }
        return hashlib.sha256(json.dumps(described, sort_keys=True).encode()).hexdigest()[:32]


def _floats(value: Any) -> Any:
    """Numbers as floats, so that 1 and 1.0 are one scene."""
    if isinstance(value, Mapping):
        return {key: _floats(entry) for key, entry in value.items()}
    return float(value) if isinstance(value, int) else value


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of a case."""

    key: str
    """The case's key."""
    solver: str
    """Who ran it."""
    scene: dict[str, dict[str, Any]]
    """What was run, as its TOML file would say."""
    version: str
    """Version of this package where it ran."""
    failure: str = ""
    """Why there is no result, in words; empty when there is one."""
    ended: str = ""
    """Why the motion stopped, in words."""
    seconds: float = 0.0
    """Wall time of all runs of the case, without that of compiling."""
    rtol: float = 0.0
    """Tolerance of the run that is reported."""
    resolved: bool = True
    """Whether the numerical error is as small as was asked."""
    pulses: tuple[dict[str, float], ...] = ()
    """Measures of each whole pulse; those in which the run begins or ends are listed in ``motion`` alone."""
    phases: tuple[list[str], ...] = ()
    """What the contact does in each pulse, in order."""
    numerical_error: tuple[dict[str, float], ...] = ()
    """Of each measure, from the run at ``FINER`` times the tolerance, per pulse; empty when nothing was asked."""
    motion: dict[str, Any] = field(default_factory=dict, repr=False)
    """The motion as JSON prints it."""
    histories: tuple[Columns, ...] = field(default=(), repr=False)
    """Forces and the rest through each pulse, if asked for."""

    @property
    def stopped(self) -> str:
        """Why a motion ended before what was asked whose pulses until then are the result; empty otherwise."""
        return self.ended if self.motion and not self.motion["completed"] else ""


class OtherBuild(RuntimeError):
    """A case came to a process whose sources or packages are not those it is meant for."""


def run_case(case: Case, homes: tuple[str, ...] = ()) -> Outcome:
    """Run a case; whatever goes wrong in it, a solver that wants to end the process too, is told in the outcome.

    Modules that enter its measures, their ``homes``, are imported first.

    Raises
    ------
    OtherBuild
        It is meant for other sources, packages or measures than are here: the result would be filed under a wrong key.
    """
    enter_from(homes)
    if case.build != (ours := build_here(case.solver)):
        raise OtherBuild(
            f"The workers run hoop-pulse {ours}, the sweep is one of {case.build}: they must agree, and so must their"
            " versions of Python, numpy, scipy, numba and scikit-fem, and the measures entered, which workers take"
            " from the script or from modules, not from a notebook's cells"
        )
    start = running_clock()
    known = {
        "key": case.key,
        "solver": case.solver,
        "scene": plain(scene_to_dict(case.scene)),
        "version": version(),
    }
    try:
        found = _resolved(case) if case.against else _once(case, case.scene)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a failing case is a row of the table, whatever it failed of: SystemExit too
        reason = " ".join(f"{type(error).__name__}: {error}".split()).rstrip(": ")
        return Outcome(**known, failure=reason, seconds=running_clock() - start)
    return Outcome(**known, **found, seconds=running_clock() - start)


class Unfinished(RuntimeError):
    """A motion that stopped before what was asked; the sentence says where and why."""


def _once(case: Case, scene: Scene, most: float = inf) -> dict[str, Any]:
    """One run; a solver that tells its progress at every step is stopped when it has taken ``most`` of them."""
    steps = 0

    def count(fraction: float) -> None:
        nonlocal steps
        steps += 1
        if steps > most:
            raise Unfinished(f"more than {most:.0f} steps at a tolerance of {scene.solve.rtol:g}")

    motion = solver(case.solver)(scene, history=case.histories, progress=count if most < inf else None)
    if not (motion.completed or case.cut):
        raise Unfinished(motion.ended)
    return _described(motion, case.histories) | {"rtol": scene.solve.rtol}


def _described(motion: Motion, histories: bool) -> dict[str, Any]:
    whole = [pulse for pulse in motion.pulses if not pulse.cut]
    return {
        "ended": motion.ended,
        "pulses": tuple(measures(motion, pulse) for pulse in whole),
        "phases": tuple(phase_sequence(motion, pulse) for pulse in whole),
        "motion": plain(motion.to_dict()),
        "histories": tuple(through(motion, pulse) for pulse in whole) if histories else (),
    }


def _resolved(case: Case) -> dict[str, Any]:
    """Run at a tolerance and at a quarter of it, and tighten until the error is a ``SHARE`` of the distance
    reported.

    Where that is out of reach (the solver stops or follows its own noise, twice in a row its error does not fall
    with the tolerance, or it would take too many steps) the best pair of runs is given, and said not to be resolved.
    """
    rtol = max(case.scene.solve.rtol, FINER * TIGHTEST)  # of which the finer run has a scene's tightest
    best, excess = _pair(case, rtol)
    last, least, stuck = best, excess, 0
    steps = spent = best["motion"].get("steps", 0)  # of the finer run; 0 where the solver does not count any
    while least > 1 and stuck < 2:
        factor = min(max(1.5 * min(excess, 3 * least), 2.0), 8.0)
        if steps:  # third order with its error per step at the tolerance: steps like rtol^(-1/3)
            factor = min(factor, (max(MOST_STEPS - spent, 0) / steps) ** 3)
        if factor < 2 or rtol / factor < FINER * TIGHTEST:
            break
        rtol /= factor
        try:
            pair, excess = _pair(case, rtol, NOISY * factor ** (1 / 3) * steps or inf, last)
        except Unfinished:
            break
        last, steps = pair, pair["motion"].get("steps", 0)
        spent += steps
        stuck = stuck + 1 if excess > 0.7 * least else 0
        if excess < least:
            best, least = pair, excess
    return best | {"resolved": _is_resolved(case, best)}


def _is_resolved(case: Case, found: dict[str, Any]) -> bool:
    """Whether the numerical error is at most its share of every distance."""
    error = found["numerical_error"][0]
    return all(error[name] <= SHARE * away for name, away in _distances(case, found["pulses"][0]).items())


def _distances(case: Case, pulse: Mapping[str, float]) -> dict[str, float]:
    """How far measures are from the rigid ones, those that are there already left out."""
    found = {name: max(abs(pulse[name] - rigid), expected) for name, rigid, expected in case.against}
    return {name: away for name, away in found.items() if away > SAME * MEASURES[name].unit.of(case.scene)}


def _pair(
    case: Case, rtol: float, most: float = inf, before: Mapping[str, Any] | None = None
) -> tuple[dict[str, Any], float]:
    """The run at a quarter of a tolerance with its error, known from the run at all of it, and how many times it is
    too large; neither may take more than ``most`` steps.

    Two runs may agree by luck: where those ``before`` them, of a greater tolerance, lie beyond their own error from
    what these say, these are in error by the rest.
    """
    coarse, fine = (
        _once(case, case.scene.replace(solve={"rtol": tolerance}), most) for tolerance in (rtol, rtol / FINER)
    )
    common = min(len(coarse["pulses"]), len(fine["pulses"]))
    if not common or (len(coarse["pulses"]) != len(fine["pulses"]) and not case.cut):
        raise Unfinished(f"no pulse came to its end: {fine['ended']}")
    if case.cut:  # of a run that stopped the pulses that the other one has too
        coarse, fine = (run | {name: run[name][:common] for name in ("pulses", "phases", "histories")}
                        for run in (coarse, fine))  # fmt: skip
    errors = tuple(_errors(old, new) for old, new in zip(coarse["pulses"], fine["pulses"], strict=True))
    if before is not None:
        for error, new, old, was in zip(
            errors, fine["pulses"], before["pulses"], before["numerical_error"], strict=False
        ):
            error |= {name: max(error[name], abs(new[name] - old[name]) - was[name]) for name in error}
    excess = 0.0
    for name, away in _distances(case, fine["pulses"][0]).items():
        allowed = max(SHARE * away, NEGLIGIBLE * MEASURES[name].unit.of(case.scene))
        excess = max(excess, errors[0][name] / allowed)
    return fine | {"numerical_error": errors}, excess


def _errors(coarse: Mapping[str, float], fine: Mapping[str, float]) -> dict[str, float]:
    """Numerical error of the finer run's measures; energy that the steps themselves took, friction may have had.

    Two runs may agree in a measure by luck: the loss, which comes of the same friction as the impulse ratio, is known
    no better than that, as a share of itself.
    """
    errors = {name: REMAINS * abs(fine[name] - coarse[name]) for name in fine}
    if "numerical_loss" in fine and "friction_loss" in fine:
        ratio = abs(fine["impulse_ratio"])
        share = errors["impulse_ratio"] / ratio if ratio > 0 else 0.0
        errors["friction_loss"] = max(
            errors["friction_loss"], abs(fine["numerical_loss"]), min(share, 1.0) * abs(fine["friction_loss"])
        )
    return errors
